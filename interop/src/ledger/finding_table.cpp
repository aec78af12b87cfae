// SPDX-License-Identifier: MIT
// What `sluice explain-finding` says. docs/ledger.md repeats the table; a test compares the two.
#include <algorithm>
#include <array>
#include <cstddef>

#include "sluice/ledger/finding.hpp"

namespace sluice::ledger {
namespace {

constexpr std::array<FindingInfo, kFindingKindCount> kTable = {{
    {FindingKind::ReadAfterWrite, "race-read-after-write", Severity::Error, "read races an earlier write",
     "A reader touches a resource while nothing orders it after the write; flicker, often in squares, or an old frame.",
     "Signal after the write, and let the reader's stream wait for that value before it reads."},
    {FindingKind::WriteAfterRead, "race-write-after-read", Severity::Error, "write races an earlier read",
     "A writer reuses a resource while a reader may still be in it; parts of the next frame show in this one.",
     "Signal after the read, and let the writer wait for it; or take a further image set."},
    {FindingKind::WriteAfterWrite, "race-write-after-write", Severity::Error, "two writes without order",
     "Two actors write, release, acquire or transition one resource and nothing orders them; either may win.",
     "Signal after the first and wait before the second."},
    {FindingKind::StaleRead, "stale-read", Severity::Error, "ordered after the wrong frame's write",
     "The read is ordered after a write, but of another version than the reader expects; the picture lags or jumps.",
     "Wait for the value that the expected frame's write signals, not for an older or a newer one."},
    {FindingKind::TimelineNotIncreasing, "timeline-not-increasing", Severity::Error, "timeline signalled backwards",
     "A timeline is signalled with a value that it has already reached; waits for it may have passed too early.",
     "Give each signal the next higher value; let one actor alone signal a timeline."},
    {FindingKind::TimelineGap, "timeline-gap", Severity::Error, "timeline jumps too far",
     "A signal raises a timeline by more than maxTimelineSemaphoreValueDifference; drivers may hang or lose it.",
     "Raise the value in steps below the limit; look for an uninitialised or wrapped value."},
    {FindingKind::BinaryWaitedTwice, "binary-waited-twice", Severity::Error, "binary waited without a new signal",
     "A wait consumed the signal of a binary semaphore, and another wait finds none; the stream hangs.",
     "Signal once for each wait; use a timeline or a fence where several have to wait."},
    {FindingKind::BinarySignalledTwice, "binary-signalled-twice", Severity::Error, "signalled again without a wait",
     "A binary semaphore or a fence is signalled while it is signalled; one of the two signals is lost.",
     "Wait between two signals; take another semaphore per hand-off; declare a fence anew after its reset."},
    {FindingKind::BinaryReusedPending, "binary-reused-pending", Severity::Error, "binary reused under a pending wait",
     "A binary semaphore is signalled anew or destroyed while nothing says that the wait on it has run.",
     "Keep it until something that follows the wait has been waited for."},
    {FindingKind::WaitUnsatisfiable, "wait-unsatisfiable", Severity::Error, "nobody can satisfy the wait",
     "A wait stands for a value that everybody who could signal it has ended without giving; the program hangs.",
     "Look for the dropped signal or the wrong value; let a watchdog signal for a renderer that died."},
    {FindingKind::WaitNotSubmitted, "wait-not-submitted", Severity::Warning, "signal not submitted yet",
     "A wait stands for a value that nobody has signalled yet, though somebody still may: legal, if it comes.",
     "Submit the signal; if the log was cut here, nothing need be wrong."},
    {FindingKind::WaitCycle, "wait-cycle", Severity::Error, "actors wait for each other",
     "Each actor of a circle waits for a signal that the next would give only after its own wait; a deadlock.",
     "Signal before waiting in one of them, or wait for the previous frame's value."},
    {FindingKind::WaitTimedOut, "wait-timed-out", Severity::Warning, "thread gave up waiting",
     "A thread's wait ended without its value; what it does next is not ordered after the work it waited for.",
     "Look at who should have signalled; skip the frame instead of reading its images."},
    {FindingKind::LayoutMismatch, "layout-mismatch", Severity::Error, "the two sides disagree on a layout",
     "One side leaves an image in a layout, the other names a different one; garbage or lost compression on some GPUs.",
     "Name the same layout in the release, the semaphore's lists and the acquire."},
    {FindingKind::OwnershipMismatch, "ownership-mismatch", Severity::Error, "touched by one who does not own",
     "An actor accesses, releases or acquires a resource that another owns or that is on its way to another.",
     "Release on the owning side, wait, acquire, then access."},
    {FindingKind::NotListed, "resource-not-listed", Severity::Error, "resource missing in a semaphore's list",
     "The wait orders execution, but the signal's or the wait's list leaves the resource out: its contents need not be "
     "visible.",
     "Add the buffer or texture to the lists of both glSignalSemaphoreEXT and glWaitSemaphoreEXT."},
    {FindingKind::ImportUuid, "import-uuid-mismatch", Severity::Error, "imported on another device or driver",
     "Memory is imported where device or driver UUID differ from the exporter's; crash or silent corruption.",
     "Choose the Vulkan device whose deviceUUID and driverUUID equal those of the GL context."},
    {FindingKind::ImportDedicated, "import-dedicated-mismatch", Severity::Error, "dedicated flag differs",
     "Memory is dedicated to one image on one side and not on the other; garbage or black on some vendors.",
     "Set GL_DEDICATED_MEMORY_OBJECT_EXT exactly when the export was a dedicated allocation."},
    {FindingKind::ImportTiling, "import-tiling-mismatch", Severity::Error, "tiling differs",
     "One side takes the image for linear, the other for optimal; a skewed or scrambled picture.",
     "Set GL_TEXTURE_TILING_EXT to the tiling that the Vulkan image was made with."},
    {FindingKind::ImportSize, "import-size-mismatch", Severity::Error, "allocation size differs",
     "The import names another size than the allocation has; failure, or access beyond the end.",
     "Pass on VkMemoryRequirements::size of the exported allocation, not width * height * bytes."},
    {FindingKind::UseAfterDestroy, "use-after-destroy", Severity::Error, "used after or while being destroyed",
     "A resource or sync is destroyed, and nothing orders a use of it before that; crash or device loss.",
     "Wait for the last use before destroying; log a wait for idle as waits on fences."},
    {FindingKind::FdClosedTwice, "fd-closed-twice", Severity::Error, "descriptor closed by one who lost it",
     "A descriptor is closed that was closed already or that a driver owns since the import; a stranger's file closes.",
     "After a successful import forget the descriptor; duplicate it when it is needed again."},
    {FindingKind::FdLeaked, "fd-leaked", Severity::Warning, "descriptor never closed",
     "A descriptor was opened and neither closed nor given away; the process runs out of them in the end.",
     "Close it or hand it to the import that takes ownership, on the failure paths as well."},
    {FindingKind::UselessWait, "useless-wait", Severity::Info, "wait for what was already implied",
     "The actor waits for a signal that an earlier wait of its own already covers; it only costs time.",
     "Leave the wait out."},
    {FindingKind::OverWait, "over-wait", Severity::Info, "thread waits in place of a queue",
     "A thread stands still until work has ended that only a stream needed, which could have waited itself.",
     "Let the stream wait for the semaphore and submit without waiting on the CPU."},
    {FindingKind::DriverReordered, "ordered-but-stale", Severity::Error, "order proven, contents wrong",
     "The model proves the read ordered after the write, yet the pixels show an older frame or a mixture.",
     "Suspect the driver (or an unlogged access): report it with this log; try another backend."},
    {FindingKind::LuckyRace, "racing-but-fine", Severity::Warning, "race that happened to end well",
     "The model shows a race on this read, the pixels were right this time; on another machine they need not be.",
     "Mend the race; the correct picture proves nothing."},
}};

constexpr bool inOrder() {
    for (std::size_t i = 0; i < kTable.size(); ++i) {
        if (static_cast<std::size_t>(kTable[i].kind) != i) {
            return false;
        }
    }
    return true;
}
static_assert(inOrder(), "findingInfo() takes the kind for the row");

}  // namespace

const FindingInfo& findingInfo(FindingKind kind) {
    return kTable.at(static_cast<std::size_t>(kind));
}

const FindingInfo* findFindingInfo(std::string_view id) {
    const auto* found =
        std::find_if(kTable.begin(), kTable.end(), [&](const FindingInfo& row) { return row.id == id; });
    return found == kTable.end() ? nullptr : found;
}

}  // namespace sluice::ledger
