// SPDX-License-Identifier: MIT
#include "cases.hpp"

namespace sluice::ledger::test {
namespace {

/// The engine writes colour, the renderer reads it, and tells when it is done.
void handOff(Script& s, bool wait_before_read, bool wait_before_reuse) {
    s.write(kGl, kColour, 1);
    s.signal(kGl, kHost, 1);
    if (wait_before_read) {
        s.wait(kQueue, kHost, 1);
    }
    s.read(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    if (wait_before_reuse) {
        s.wait(kGl, kDone, 1);
    }
}

void reuse(Script& s, bool wait) {
    handOff(s, true, wait);
    s.write(kGl, kColour, 2);
}

void twoWriters(Script& s, bool wait) {
    s.write(kGl, kColour, 1);
    s.signal(kGl, kHost, 1);
    if (wait) {
        s.wait(kQueue, kHost, 1);
    }
    s.write(kQueue, kColour, 1);
}

void stale(Script& s, std::uint64_t second_wait) {
    handOff(s, true, true);
    s.write(kGl, kColour, 2);
    s.signal(kGl, kHost, 2);
    s.wait(kQueue, kHost, 2);
    s.read(kQueue, kColour, second_wait);
}

void increasing(Script& s, std::uint64_t second) {
    s.signal(kGl, kHost, 1);
    s.signal(kGl, kHost, second);
}

void binaryWaits(Script& s, bool again) {
    s.signal(kGl, kBinary, 0);
    s.wait(kQueue, kBinary, 0);
    if (again) {
        s.wait(kQueue, kBinary, 0);
    }
}

void binarySignals(Script& s, bool wait_between) {
    s.signal(kGl, kBinary, 0);
    if (wait_between) {
        s.wait(kQueue, kBinary, 0);
        s.signal(kQueue, kDone, 1);
        s.wait(kGl, kDone, 1);
    }
    s.signal(kGl, kBinary, 0);
    s.wait(kQueue, kBinary, 0);
}

void binaryReuse(Script& s, bool told) {
    s.signal(kGl, kBinary, 0);
    s.wait(kQueue, kBinary, 0);
    s.signal(kQueue, kDone, 1);
    if (told) {
        s.wait(kGl, kDone, 1);
    }
    s.signal(kGl, kBinary, 0);
    s.wait(kQueue, kBinary, 0);
}

void missingSignal(Script& s, bool signal) {
    s.signal(kGl, kHost, 1);
    s.wait(kQueue, kHost, 2);
    if (signal) {
        s.signal(kGl, kHost, 2);
    }
}

void circle(Script& s, bool signal_first) {
    if (signal_first) {
        s.signal(kGl, kHost, 1);
    }
    s.wait(kGl, kDone, 1);
    if (!signal_first) {
        s.signal(kGl, kHost, 1);
    }
    s.wait(kQueue, kHost, 1);
    s.signal(kQueue, kDone, 1);
}

void timedOut(Script& s, bool in_vain) {
    s.submit(kEngine, kQueue);
    s.signal(kQueue, kDone, 1);
    s.wait(kEngine, kDone, 1, 5 * kMs, in_vain ? kTimedOut : 0);
}

void unlisted(Script& s, bool in_signal, bool in_wait) {
    s.write(kQueue, kColour, 1);
    s.names(kQueue, kDepth);
    if (in_signal) {
        s.names(kQueue, kColour);
    }
    s.signal(kQueue, kListed, 1);
    if (in_wait) {
        s.names(kGl, kColour);
    }
    s.names(kGl, kDepth);
    s.wait(kGl, kListed, 1);
    s.read(kGl, kColour, 1);
}

void readBack(Script& s, bool ordered, Verdict verdict) {
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    if (ordered) {
        s.wait(kGl, kDone, 1);
    }
    s.read(kGl, kColour, 1);
    s.witness(kGl, kColour, verdict == Verdict::Fresh ? 1 : 0, verdict);
}

}  // namespace

std::vector<Case> orderCases() {
    return {
        {FindingKind::ReadAfterWrite, [](Script& s) { handOff(s, false, true); },
         [](Script& s) { handOff(s, true, true); }},
        {FindingKind::WriteAfterRead, [](Script& s) { reuse(s, false); }, [](Script& s) { reuse(s, true); }},
        {FindingKind::WriteAfterWrite, [](Script& s) { twoWriters(s, false); }, [](Script& s) { twoWriters(s, true); }},
        {FindingKind::StaleRead, [](Script& s) { stale(s, 3); }, [](Script& s) { stale(s, 2); }},
        {FindingKind::TimelineNotIncreasing, [](Script& s) { increasing(s, 1); }, [](Script& s) { increasing(s, 2); }},
        {FindingKind::TimelineGap, [](Script& s) { increasing(s, 0x80000001); },
         [](Script& s) { increasing(s, 0x80000000); }},
        {FindingKind::BinaryWaitedTwice, [](Script& s) { binaryWaits(s, true); },
         [](Script& s) { binaryWaits(s, false); }},
        {FindingKind::BinarySignalledTwice, [](Script& s) { binarySignals(s, false); },
         [](Script& s) { binarySignals(s, true); }},
        {FindingKind::BinaryReusedPending, [](Script& s) { binaryReuse(s, false); },
         [](Script& s) { binaryReuse(s, true); }},
        {FindingKind::WaitUnsatisfiable, [](Script& s) { missingSignal(s, false); },
         [](Script& s) { missingSignal(s, true); }},
        {FindingKind::WaitNotSubmitted, [](Script& s) { missingSignal(s, false); },
         [](Script& s) { missingSignal(s, true); }, End::Truncated},
        {FindingKind::WaitCycle, [](Script& s) { circle(s, false); }, [](Script& s) { circle(s, true); }},
        {FindingKind::WaitTimedOut, [](Script& s) { timedOut(s, true); }, [](Script& s) { timedOut(s, false); }},
        {FindingKind::NotListed, [](Script& s) { unlisted(s, true, false); },
         [](Script& s) { unlisted(s, true, true); }},
        {FindingKind::NotListed, [](Script& s) { unlisted(s, false, true); },
         [](Script& s) { unlisted(s, true, true); }},
        {FindingKind::DriverReordered, [](Script& s) { readBack(s, true, Verdict::Stale); },
         [](Script& s) { readBack(s, true, Verdict::Fresh); }},
        {FindingKind::DriverReordered, [](Script& s) { readBack(s, true, Verdict::Torn); },
         [](Script& s) { readBack(s, true, Verdict::Fresh); }},
        {FindingKind::LuckyRace,
         [](Script& s) { readBack(s, false, Verdict::Fresh); },
         [](Script& s) { readBack(s, true, Verdict::Fresh); },
         End::Closed,
         {FindingKind::ReadAfterWrite}},
    };
}

}  // namespace sluice::ledger::test
