// SPDX-License-Identifier: MIT
// What the ordering ledger costs for each event of a clean ring of three image sets. items_per_second are events.
#include <benchmark/benchmark.h>

#include "sluice/ledger/ledger.hpp"

namespace {

using namespace sluice::ledger;

constexpr ActorId kGl = 0, kQueue = 1;
constexpr ObjectId kHost = 0, kDone = 1;
constexpr int kEventsPerFrame = 9;

void tell(Ledger& ledger, EventKind kind, ActorId actor, ObjectId object, std::uint64_t value) {
    Event event;
    event.kind = kind;
    event.actor = actor;
    event.object = object;
    event.value = value;
    ledger.record(event);
}

void declare(Ledger& ledger) {
    ledger.declareActor(kGl, ActorKind::GlContext, "gl");
    ledger.declareActor(kQueue, ActorKind::VulkanQueue, "queue");
    ledger.declareSync(kHost, SyncKind::Timeline, "host-to-renderer", 0, 0);
    ledger.declareSync(kDone, SyncKind::Timeline, "renderer-to-host", 0, 0);
}

void frame(Ledger& ledger, std::uint64_t k) {
    const auto set = static_cast<ObjectId>(k % 3);
    tell(ledger, EventKind::Write, kGl, set, k);
    tell(ledger, EventKind::Signal, kGl, kHost, 2 * k - 1);
    tell(ledger, EventKind::Wait, kQueue, kHost, 2 * k - 1);
    tell(ledger, EventKind::Read, kQueue, set, k);
    tell(ledger, EventKind::Write, kQueue, 3 + set, k);
    tell(ledger, EventKind::Signal, kQueue, kDone, k);
    tell(ledger, EventKind::Wait, kGl, kDone, k);
    tell(ledger, EventKind::Read, kGl, 3 + set, k);
    tell(ledger, EventKind::Signal, kGl, kHost, 2 * k);
}

/// Every wait finds its signal.
void ring(benchmark::State& state) {
    Ledger ledger;
    declare(ledger);
    std::uint64_t k = 0;
    while (state.KeepRunning()) {
        frame(ledger, ++k);
    }
    state.SetItemsProcessed(state.iterations() * kEventsPerFrame);
    state.counters["findings"] = static_cast<double>(ledger.findings().size());
    state.counters["bytes"] = static_cast<double>(ledger.memoryBytes());
}
BENCHMARK(ring);

/// The renderer's half of each frame is logged before the host's: every wait is held once.
void ringHeld(benchmark::State& state) {
    Ledger ledger;
    declare(ledger);
    std::uint64_t k = 0;
    while (state.KeepRunning()) {
        ++k;
        const auto set = static_cast<ObjectId>(k % 3);
        tell(ledger, EventKind::Wait, kQueue, kHost, 2 * k - 1);
        tell(ledger, EventKind::Read, kQueue, set, k);
        tell(ledger, EventKind::Write, kQueue, 3 + set, k);
        tell(ledger, EventKind::Signal, kQueue, kDone, k);
        tell(ledger, EventKind::Write, kGl, set, k);
        tell(ledger, EventKind::Signal, kGl, kHost, 2 * k - 1);
        tell(ledger, EventKind::Wait, kGl, kDone, k);
        tell(ledger, EventKind::Read, kGl, 3 + set, k);
        tell(ledger, EventKind::Signal, kGl, kHost, 2 * k);
    }
    state.SetItemsProcessed(state.iterations() * kEventsPerFrame);
    state.counters["findings"] = static_cast<double>(ledger.findings().size());
}
BENCHMARK(ringHeld);

}  // namespace

BENCHMARK_MAIN();
