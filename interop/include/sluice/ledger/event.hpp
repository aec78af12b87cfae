// SPDX-License-Identifier: MIT
// What the ordering ledger is told: plain records of who signalled, waited, touched what, in which order. No GL or
// Vulkan type: a GL context, a Vulkan queue, a thread and a process are all actors.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace sluice::ledger {

using ActorId = std::uint16_t;
using ObjectId = std::uint32_t;  ///< a sync object, a resource or an fd; one number space per kind of object

inline constexpr ActorId kNoActor = 0xFFFF;
inline constexpr ObjectId kNoObject = 0xFFFFFFFF;

/// Who runs events in one order of its own. A GL context is its command stream; a Vulkan queue is taken in submission
/// order. The thread that records their commands is another actor.
enum class ActorKind : std::uint8_t { GlContext, VulkanQueue, HostThread, BridgeThread, Process };

enum class SyncKind : std::uint8_t {
    Timeline,  ///< a 64-bit counter; a wait for v is satisfied by any signal of at least v
    Binary,    ///< one slot: each signal serves one wait
    Fence,     ///< signalled once, waited any number of times (GLsync, VkFence)
};

/// Facts of an object, as bits of Event::flags in its Declare event.
enum ObjectFlag : std::uint16_t {
    kListedOnly =
        1U << 0,  ///< sync: makes only the resources visible that its signal and its wait name (GL_EXT_semaphore)
};

/// How memory was made or imported; the fields that both sides have to agree on.
struct MemoryFacts {
    std::array<std::uint8_t, 16> device_uuid{};
    std::array<std::uint8_t, 16> driver_uuid{};
    std::uint64_t size = 0;       ///< bytes of the allocation
    std::uint32_t tiling = 0;     ///< 0 optimal, 1 linear
    std::uint32_t dedicated = 0;  ///< 1 when the memory belongs to this one image
    bool operator==(const MemoryFacts&) const = default;
};

/// Image layouts are the Vulkan numbers (VK_IMAGE_LAYOUT_GENERAL is 1); owners are actors, or kNoActor for "external".
enum class EventKind : std::uint8_t {
    // Order. `actor` runs the event; `object` is the sync object.
    Signal,  ///< value
    Wait,    ///< value; for a thread it is logged when it has ended, with duration_ns; kTimedOut when it ended in vain
    WaitBegin,  ///< threads only: the wait that a later Wait of the same actor and object will close; for the watchdog
    Submit,  ///< a thread (`actor`) gives work to a stream (`object` is its ActorId): the stream's events that follow
             ///< in the log, until the next Submit, were given with it. value: number of the submission
    // Access. `object` is the resource; value: the content's version (frame) that is written, or that the reader
    // expects
    // (0: any).
    Read,
    Write,
    // Ownership and layout. value: new layout << 32 | old layout; aux: the other owner (ActorId, or kNoActor:
    // external).
    Release,
    Acquire,
    Layout,  ///< a transition without a change of owner
    // Names of a kListedOnly sync: come directly before the Signal or Wait of the same actor that they belong to.
    Names,  ///< object: the resource; value: its layout there, 0 when none is given
    // Objects.
    Export,   ///< memory of resource `object`; the facts come with it
    Import,   ///< the same on the other side
    Destroy,  ///< resource or sync (aux: ObjectClass)
    FdOpen,   ///< object: the descriptor's number; value: an owner tag of the logger's choice
    FdGive,   ///< the ownership of descriptor `object` has gone to a driver or another process
    FdClose,  ///< object: the descriptor's number
    // Life.
    Frame,     ///< value: the frame that `actor` begins; its later events belong to it
    ActorEnd,  ///< `actor` will signal nothing more (destroyed, exited, crashed)
    Witness,   ///< the pixels' verdict on a read: object: the resource; value: version found; aux: Verdict
};
inline constexpr std::size_t kEventKindCount = static_cast<std::size_t>(EventKind::Witness) + 1;

enum class ObjectClass : std::uint8_t { Sync, Resource, Fd };
/// What the content check saw: the version that was expected, an older one, or parts of several.
enum class Verdict : std::uint8_t { Fresh, Stale, Torn };

/// Bits of Event::flags.
enum EventFlag : std::uint16_t {
    kTimedOut = 1U << 8,  ///< a Wait that ended without its value
    kForced = 1U << 9,    ///< a Signal that a watchdog gave in the place of the rightful one
    kGaveUp = 1U << 10,   ///< a Wait that ended without its value, for a cause that is told elsewhere: no finding
    kUntold = 1U << 11,   ///< an ActorEnd: what the actor did was not told, so what waits for it is not judged
};

/// One record, 48 bytes, fixed layout, little-endian in a log file.
struct Event {
    EventKind kind{};
    std::uint8_t reserved = 0;
    std::uint16_t flags = 0;
    ActorId actor = kNoActor;
    std::uint16_t aux = 0;
    ObjectId object = kNoObject;
    std::uint32_t frame = 0;  ///< 0: the frame of the actor's last Frame event
    std::uint64_t value = 0;
    std::uint64_t time_ns = 0;  ///< CLOCK_MONOTONIC at the begin
    std::uint64_t duration_ns = 0;
    std::uint64_t sequence = 0;  ///< place in the log; the writer fills it
};
static_assert(sizeof(Event) == 48);

[[nodiscard]] std::string_view toString(EventKind kind);
[[nodiscard]] std::string_view toString(ActorKind kind);
[[nodiscard]] std::string_view toString(SyncKind kind);
[[nodiscard]] std::string_view toString(Verdict verdict);

}  // namespace sluice::ledger
