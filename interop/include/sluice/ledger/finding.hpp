// SPDX-License-Identifier: MIT
// What the ledger finds, each kind with a stable id that tools, tests and suppressions may rely on.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/ledger/event.hpp"

namespace sluice::ledger {

enum class Severity : std::uint8_t { Info, Warning, Error };

enum class FindingKind : std::uint8_t {
    ReadAfterWrite,         ///< race-read-after-write
    WriteAfterRead,         ///< race-write-after-read
    WriteAfterWrite,        ///< race-write-after-write
    StaleRead,              ///< stale-read: ordered, but after the wrong frame's write
    TimelineNotIncreasing,  ///< timeline-not-increasing
    TimelineGap,            ///< timeline-gap
    BinaryWaitedTwice,      ///< binary-waited-twice
    BinarySignalledTwice,   ///< binary-signalled-twice
    BinaryReusedPending,  ///< binary-reused-pending: destroyed or signalled anew while a recorded wait still depends on
                          ///< it
    WaitUnsatisfiable,    ///< wait-unsatisfiable: everyone who could signal has ended
    WaitNotSubmitted,     ///< wait-not-submitted: nobody has signalled yet, somebody still may
    WaitCycle,            ///< wait-cycle
    WaitTimedOut,         ///< wait-timed-out: a thread gave up
    LayoutMismatch,       ///< layout-mismatch
    OwnershipMismatch,    ///< ownership-mismatch: an access or an acquire by one who does not own
    NotListed,            ///< resource-not-listed
    ImportUuid,           ///< import-uuid-mismatch
    ImportDedicated,      ///< import-dedicated-mismatch
    ImportTiling,         ///< import-tiling-mismatch
    ImportSize,           ///< import-size-mismatch
    UseAfterDestroy,      ///< use-after-destroy
    FdClosedTwice,        ///< fd-closed-twice
    FdLeaked,             ///< fd-leaked
    UselessWait,          ///< useless-wait: already implied
    OverWait,             ///< over-wait: a thread stood still for what only a queue needed
    DriverReordered,      ///< ordered-but-stale: the model proves order, the pixels show an older or a mixed frame
    LuckyRace,            ///< racing-but-fine: the model shows a race, the pixels happened to be right
};
inline constexpr std::size_t kFindingKindCount = static_cast<std::size_t>(FindingKind::LuckyRace) + 1;

/// The static half of a kind: what `sluice explain-finding` prints.
struct FindingInfo {
    FindingKind kind;
    std::string_view id;  ///< stable, kebab-case
    Severity severity;
    std::string_view title;    ///< a few words
    std::string_view meaning;  ///< what it is and what one sees on the screen
    std::string_view remedy;   ///< what to change
};
[[nodiscard]] const FindingInfo& findingInfo(FindingKind kind);
/// nullptr when nothing has that id.
[[nodiscard]] const FindingInfo* findFindingInfo(std::string_view id);
[[nodiscard]] std::string_view toString(Severity severity);

/// One thing found. The two events are copies, so that a finding outlives the ledger; `second` is the one at which it
/// showed. A finding about one event only has first.kind == second.kind and equal sequences.
struct Finding {
    FindingKind kind{};
    Event first, second;
    std::string
        edge;  ///< the missing or excessive edge: "gl:signal(host-to-renderer, 7) -> queue:wait(host-to-renderer, 7)"
    std::uint32_t frame = 0;
    std::uint64_t cost_ns = 0;       ///< useless-wait, over-wait, wait-timed-out: time lost
    std::string sentence;            ///< one sentence with the names and values of this case
    std::string remedy;              ///< one sentence with the names of this case
    std::vector<std::string> chain;  ///< wait-*: who waits for whom, one line each
    std::uint64_t count = 1;         ///< how often it was seen: the same kind, object and pair of sites is one Finding
};

}  // namespace sluice::ledger
