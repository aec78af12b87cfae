// SPDX-License-Identifier: MIT
#include "cases.hpp"

namespace sluice::ledger::test {
namespace {

constexpr std::uint32_t kGeneral = 1, kAttachment = 2, kReadOnly = 5;

void transfer(Script& s, bool release, std::uint32_t acquired_from) {
    s.acquire(kQueue, kColour, kGeneral, kAttachment);
    s.write(kQueue, kColour, 1);
    if (release) {
        s.release(kQueue, kColour, kAttachment, kReadOnly, kQueue2);
    }
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kDone, 1);
    s.acquire(kQueue2, kColour, acquired_from, acquired_from == kAttachment ? kReadOnly : acquired_from, kQueue);
    s.read(kQueue2, kColour, 1);
}

void keepsTouching(Script& s, bool after_release) {
    s.acquire(kQueue, kColour, kGeneral, kGeneral);
    if (!after_release) {
        s.write(kQueue, kColour, 1);
    }
    s.release(kQueue, kColour, kGeneral, kGeneral);
    if (after_release) {
        s.write(kQueue, kColour, 1);
    }
    s.signal(kQueue, kDone, 1);
    s.wait(kGl, kDone, 1);
    s.read(kGl, kColour, 1);
}

void releasedTwice(Script& s, bool twice) {
    s.release(kQueue, kColour, kGeneral, kGeneral);
    s.signal(kQueue, kDone, 1);
    s.wait(kQueue2, kDone, 1);
    if (!twice) {
        s.acquire(kQueue2, kColour, kGeneral, kGeneral);
    }
    s.release(kQueue2, kColour, kGeneral, kGeneral);
}

void glLists(Script& s, std::uint32_t layout_in_wait) {
    s.write(kQueue, kColour, 1);
    s.release(kQueue, kColour, kGeneral, kReadOnly);
    s.names(kQueue, kColour, kReadOnly);
    s.signal(kQueue, kListed, 1);
    s.names(kGl, kColour, layout_in_wait);
    s.wait(kGl, kListed, 1);
    s.read(kGl, kColour, 1);
    s.names(kGl, kColour, kAttachment);
    s.signal(kGl, kListed, 2);
    s.names(kQueue, kColour);
    s.wait(kQueue, kListed, 2);
    s.acquire(kQueue, kColour, kAttachment, kGeneral);
}

MemoryFacts facts() {
    MemoryFacts some;
    some.device_uuid[3] = 7;
    some.driver_uuid[0] = 9;
    some.size = 4096;
    some.dedicated = 1;
    return some;
}

void share(Script& s, const MemoryFacts& imported) {
    s.ledger.memoryFacts(kColour, facts());
    s.event(EventKind::Export, kQueue, kColour);
    s.ledger.memoryFacts(kColour, imported);
    s.event(EventKind::Import, kGl, kColour);
}

template <typename Change>
Case import(FindingKind kind, Change change) {
    return {kind,
            [change](Script& s) {
                MemoryFacts other = facts();
                change(other);
                share(s, other);
            },
            [](Script& s) { share(s, facts()); }};
}

void destroyResource(Script& s, bool after_wait) {
    s.submit(kEngine, kQueue);
    s.write(kQueue, kColour, 1);
    s.signal(kQueue, kFence, 0);
    if (after_wait) {
        s.wait(kEngine, kFence, 0, kMs);
    }
    s.destroy(kEngine, ObjectClass::Resource, kColour);
}

void destroySync(Script& s, bool before_wait) {
    s.signal(kGl, kHost, 1);
    if (before_wait) {
        s.destroy(kGl, ObjectClass::Sync, kHost);
    }
    s.wait(kQueue, kHost, 1);
    s.signal(kQueue, kDone, 1);
    s.wait(kGl, kDone, 1);
    if (!before_wait) {
        s.destroy(kGl, ObjectClass::Sync, kHost);
    }
}

void destroyPendingBinary(Script& s, bool pending) {
    if (!pending) {
        s.signal(kGl, kBinary, 0);
    }
    s.wait(kQueue, kBinary, 0);
    s.signal(kQueue, kFence, 0);
    if (!pending) {
        s.wait(kEngine, kFence, 0);
    }
    s.destroy(kEngine, ObjectClass::Sync, kBinary);
}

void readOnlyInTime(Script& s, bool destroyed_first) {
    if (destroyed_first) {
        s.destroy(kGl, ObjectClass::Resource, kDepth);
    }
    s.read(kGl, kDepth);
    if (!destroyed_first) {
        s.destroy(kGl, ObjectClass::Resource, kDepth);
    }
}

void closing(Script& s, bool given, int closes) {
    s.event(EventKind::FdOpen, kEngine, 7, 1);
    if (given) {
        s.event(EventKind::FdGive, kEngine, 7);
    }
    for (int i = 0; i < closes; ++i) {
        s.event(EventKind::FdClose, kEngine, 7);
    }
}

}  // namespace

std::vector<Case> stateCases() {
    return {
        {FindingKind::LayoutMismatch, [](Script& s) { transfer(s, true, kGeneral); },
         [](Script& s) { transfer(s, true, kReadOnly); }},
        {FindingKind::LayoutMismatch, [](Script& s) { glLists(s, kGeneral); },
         [](Script& s) { glLists(s, kReadOnly); }},
        {FindingKind::OwnershipMismatch, [](Script& s) { transfer(s, false, kAttachment); },
         [](Script& s) { transfer(s, true, kAttachment); }},
        {FindingKind::OwnershipMismatch, [](Script& s) { keepsTouching(s, true); },
         [](Script& s) { keepsTouching(s, false); }},
        {FindingKind::OwnershipMismatch, [](Script& s) { releasedTwice(s, true); },
         [](Script& s) { releasedTwice(s, false); }},
        import(FindingKind::ImportUuid, [](MemoryFacts& other) { other.device_uuid[3] = 8; }),
        import(FindingKind::ImportUuid, [](MemoryFacts& other) { other.driver_uuid[0] = 8; }),
        import(FindingKind::ImportDedicated, [](MemoryFacts& other) { other.dedicated = 0; }),
        import(FindingKind::ImportTiling, [](MemoryFacts& other) { other.tiling = 1; }),
        import(FindingKind::ImportSize, [](MemoryFacts& other) { other.size = 4000; }),
        {FindingKind::UseAfterDestroy, [](Script& s) { destroyResource(s, false); },
         [](Script& s) { destroyResource(s, true); }},
        {FindingKind::UseAfterDestroy, [](Script& s) { destroySync(s, true); },
         [](Script& s) { destroySync(s, false); }},
        {FindingKind::UseAfterDestroy, [](Script& s) { readOnlyInTime(s, true); },
         [](Script& s) { readOnlyInTime(s, false); }},
        {FindingKind::BinaryReusedPending, [](Script& s) { destroyPendingBinary(s, true); },
         [](Script& s) { destroyPendingBinary(s, false); }},
        {FindingKind::FdClosedTwice, [](Script& s) { closing(s, false, 2); }, [](Script& s) { closing(s, false, 1); }},
        {FindingKind::FdClosedTwice, [](Script& s) { closing(s, true, 1); }, [](Script& s) { closing(s, true, 0); }},
        {FindingKind::FdLeaked, [](Script& s) { closing(s, false, 0); }, [](Script& s) { closing(s, true, 0); }},
    };
}

}  // namespace sluice::ledger::test
