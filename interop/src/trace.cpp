// SPDX-License-Identifier: MIT
#include "sluice/trace.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstring>
#include <ctime>

#include "sluice/abi_sizes.hpp"

namespace sluice {

namespace {

// Keeps the counters that producers fight over apart from those of the consumer; 64 on every CPU we build for.
constexpr std::size_t kCacheLine = 64;

bool timelineEvent(const SluiceTraceEvent& event) {
    return event.kind == SLUICE_TRACE_SIGNAL || event.kind == SLUICE_TRACE_WAIT;
}

/// Events of kinds that this side does not know cannot be kept truthfully.
bool understood(const SluiceTraceEvent& event) {
    return event.kind < SLUICE_TRACE_KIND_COUNT && event.track < SLUICE_TRACK_COUNT &&
           (!timelineEvent(event) || event.direction <= SLUICE_SIMULATION_TO_RENDERER);
}

TraceRecord toRecord(const SluiceTraceEvent& event) {
    TraceRecord record{};
    record.kind = static_cast<SluiceTraceKind>(event.kind);
    record.track = static_cast<SluiceTrack>(event.track);
    record.direction = static_cast<SluiceDirection>(timelineEvent(event) ? event.direction : event.direction & 1U);
    record.begin_ns = event.begin_ns;
    record.duration_ns = event.duration_ns;
    record.frame = event.frame;
    record.value = event.value;
    record.bytes = event.bytes;
    if (event.name != nullptr) {
        std::memcpy(record.name.data(), event.name, strnlen(event.name, record.name.size() - 1));
    }
    return record;
}

}  // namespace

std::uint64_t monotonicNanoseconds() {
    std::timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(now.tv_nsec);
}

// A producer first reserves room (`used`), then takes a ticket (`head`); ticket t writes slot t mod capacity and
// publishes it by storing t + 1 in the slot's sequence. Because room is reserved before the ticket is taken, at most
// `capacity` tickets are ever out, so the slot is free. The consumer frees slots in ticket order. The reservation
// counter and the head are read and written with acquire and release, which orders the consumer's copy of a slot before
// its next use.
struct Trace::Ring {
    struct Slot {
        std::atomic<std::uint64_t> sequence{0};  ///< ticket + 1 of the record it holds
        bool taken = false;                      ///< consumer only: copied out, not yet freed
        TraceRecord record{};
    };

    explicit Ring(std::size_t capacity) : slots(capacity) {}

    alignas(kCacheLine) std::atomic<std::uint64_t> used{0};
    std::atomic<std::uint64_t> head{0};
    std::atomic<std::uint64_t> dropped{0};
    alignas(kCacheLine) std::uint64_t tail = 0;  ///< consumer only
    std::vector<Slot> slots;
};

Trace::Trace(std::size_t capacity) : ring_(std::make_unique<Ring>(std::bit_ceil(std::max<std::size_t>(capacity, 1)))) {}

Trace::~Trace() = default;

void Trace::record(const SluiceTraceEvent& event) {
    Ring& ring = *ring_;
    const bool whole = event.struct_size >= kAbiMinimum<SluiceTraceEvent>;
    const SluiceTraceEvent known = whole ? readAbiStruct(event) : SluiceTraceEvent{};
    if (!whole || !understood(known)) {
        ring.dropped.fetch_add(1, std::memory_order_relaxed);
        return;
    }
    if (ring.used.fetch_add(1, std::memory_order_acq_rel) >= ring.slots.size()) {
        ring.used.fetch_sub(1, std::memory_order_acq_rel);
        ring.dropped.fetch_add(1, std::memory_order_relaxed);
        return;
    }
    const std::uint64_t ticket = ring.head.fetch_add(1, std::memory_order_acq_rel);
    Ring::Slot& slot = ring.slots[ticket & (ring.slots.size() - 1)];
    slot.record = toRecord(known);
    slot.sequence.store(ticket + 1, std::memory_order_release);
}

std::vector<TraceRecord> Trace::drain() {
    Ring& ring = *ring_;
    const std::uint64_t mask = ring.slots.size() - 1;
    const std::uint64_t head = ring.head.load(std::memory_order_acquire);
    std::vector<TraceRecord> records;
    records.reserve(head - ring.tail);
    // A slot whose writer is not done yet is passed over, so that one stalled thread does not hide what others
    // recorded.
    for (std::uint64_t ticket = ring.tail; ticket != head; ++ticket) {
        Ring::Slot& slot = ring.slots[ticket & mask];
        if (!slot.taken && slot.sequence.load(std::memory_order_acquire) == ticket + 1) {
            records.push_back(slot.record);
            slot.taken = true;
        }
    }
    for (; ring.tail != head && ring.slots[ring.tail & mask].taken; ++ring.tail) {
        ring.slots[ring.tail & mask].taken = false;
        ring.used.fetch_sub(1, std::memory_order_acq_rel);
    }
    std::ranges::stable_sort(records, {}, &TraceRecord::begin_ns);
    return records;
}

std::uint64_t Trace::dropped() const {
    return ring_->dropped.load(std::memory_order_relaxed);
}

TraceTotals totals(const std::vector<TraceRecord>& records) {
    TraceTotals sum;
    for (const TraceRecord& record : records) {
        const auto kind = static_cast<std::size_t>(record.kind);
        if (kind < sum.count.size()) {
            ++sum.count[kind];
            sum.bytes[kind] += record.bytes;
            sum.nanoseconds[kind] += record.duration_ns;
        }
    }
    return sum;
}

}  // namespace sluice
