// SPDX-License-Identifier: MIT
#include "cases.hpp"

namespace sluice::ledger::test {
namespace {

void waitsAgain(Script& s, bool again) {
    s.wait(kEngine, kDone, 0);  // the initial value: how loops begin
    s.submit(kEngine, kQueue);
    s.signal(kQueue, kFence, 0);
    s.wait(kEngine, kFence, 0, kMs);
    if (again) {
        s.wait(kEngine, kFence, 0, 10);
    }
}

void ownSignal(Script& s, ActorId waiter) {
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(waiter, kDone, 1);
    s.read(waiter, kColour, 1);
}

void impliedElsewhere(Script& s, std::uint64_t cost) {
    s.signal(kQueue, kDone, 1);
    s.signal(kQueue, kFence, 0);
    s.wait(kEngine, kFence, 0, kMs);
    s.wait(kEngine, kDone, 1, cost);
}

/// The engine waits for the renderer on the CPU, and then has the second queue read what was written.
void standsStill(Script& s, bool on_cpu, bool looks_itself) {
    s.submit(kEngine, kQueue);
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    if (on_cpu) {
        s.wait(kEngine, kDone, 1, 3 * kMs);
    }
    if (looks_itself) {
        s.read(kEngine, kColour, 1);
    }
    s.submit(kEngine, kQueue2);
    if (!on_cpu) {
        s.wait(kQueue2, kDone, 1);
    }
    s.read(kQueue2, kColour, 1);
}

/// A GL stream that never met this timeline may not be able to wait for it: that is what bridges are for.
void cannotWait(Script& s, ActorId stream) {
    s.submit(kEngine, kQueue);
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kEngine, kDone, 1, 3 * kMs);
    s.submit(kEngine, stream);
    s.read(stream, kColour, 1);
}

/// What one stream could have waited for, another could not; or the stream waits itself, and the thread paces its
/// frames.
void waitsForBoth(Script& s, bool for_gl, bool queue_waits) {
    s.submit(kEngine, kQueue);
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kEngine, kDone, 1, 3 * kMs);
    s.submit(kEngine, kQueue2);
    if (queue_waits) {
        s.wait(kQueue2, kDone, 1);
    }
    s.read(kQueue2, kColour, 1);
    if (for_gl) {
        s.submit(kEngine, kGl);
        s.read(kGl, kColour, 1);
    }
}

}  // namespace

std::vector<Case> costCases() {
    return {
        {FindingKind::UselessWait, [](Script& s) { waitsAgain(s, true); }, [](Script& s) { waitsAgain(s, false); }},
        {FindingKind::UselessWait, [](Script& s) { ownSignal(s, kQueue); }, [](Script& s) { ownSignal(s, kGl); }},
        {FindingKind::UselessWait, [](Script& s) { impliedElsewhere(s, kMs); },
         [](Script& s) { impliedElsewhere(s, 1000); }},
        {FindingKind::OverWait, [](Script& s) { standsStill(s, true, false); },
         [](Script& s) { standsStill(s, false, false); }},
        {FindingKind::OverWait, [](Script& s) { standsStill(s, true, false); },
         [](Script& s) { standsStill(s, true, true); }},
        {FindingKind::OverWait, [](Script& s) { waitsForBoth(s, false, false); },
         [](Script& s) { waitsForBoth(s, true, false); }},
        {FindingKind::OverWait, [](Script& s) { waitsForBoth(s, false, false); },
         [](Script& s) { waitsForBoth(s, false, true); }},
        {FindingKind::OverWait, [](Script& s) { cannotWait(s, kQueue2); }, [](Script& s) { cannotWait(s, kGl); }},
    };
}

std::vector<Case> allCases() {
    std::vector<Case> all = orderCases();
    for (const auto& more : {stateCases(), costCases()}) {
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

}  // namespace sluice::ledger::test
