// SPDX-License-Identifier: MIT
// What tracing costs: an event site with tracing off (NULL callback) against one with it on. Quote the ratio, and from
// one run of both: the machines change speed.
#include <benchmark/benchmark.h>

#include "sluice/trace.hpp"

namespace {

using sluice::Trace;

/// An event site as host and renderer write it: no clock is read unless the callback is there.
void eventSite(const SluiceHostServices& services, std::uint64_t value) {
    if (services.trace == nullptr) {
        return;
    }
    SluiceTraceEvent event{};
    event.struct_size = sizeof event;
    event.kind = SLUICE_TRACE_SIGNAL;
    event.track = SLUICE_TRACK_HOST_GL;
    event.begin_ns = sluice::monotonicNanoseconds();
    event.value = value;
    event.name = "signal";
    services.trace(services.user, &event);
}

void recordInto(void* user, const SluiceTraceEvent* event) {
    static_cast<Trace*>(user)->record(*event);
}

void drainNow(benchmark::State& state, Trace& trace) {
    state.PauseTiming();
    benchmark::DoNotOptimize(trace.drain());
    state.ResumeTiming();
}

constexpr std::size_t kCapacity = 1U << 16U;
constexpr int kBatch = 1 << 14;  // below the capacity, so that nothing is dropped

void off(benchmark::State& state) {
    SluiceHostServices services{};
    benchmark::DoNotOptimize(services);
    std::uint64_t value = 0;
    while (state.KeepRunningBatch(kBatch)) {
        for (int i = 0; i < kBatch; ++i) {
            benchmark::ClobberMemory();
            eventSite(services, ++value);
        }
    }
}
BENCHMARK(off);

void on(benchmark::State& state) {
    Trace trace(kCapacity);
    SluiceHostServices services{};
    services.user = &trace;
    services.trace = recordInto;
    benchmark::DoNotOptimize(services);
    std::uint64_t value = 0;
    while (state.KeepRunningBatch(kBatch)) {
        for (int i = 0; i < kBatch; ++i) {
            benchmark::ClobberMemory();
            eventSite(services, ++value);
        }
        drainNow(state, trace);
    }
    state.counters["dropped"] = static_cast<double>(trace.dropped());
}
BENCHMARK(on);

/// record() alone, without the clock.
void recordOnly(benchmark::State& state) {
    Trace trace(kCapacity);
    SluiceTraceEvent event{};
    event.struct_size = sizeof event;
    event.name = "signal";
    while (state.KeepRunningBatch(kBatch)) {
        for (int i = 0; i < kBatch; ++i) {
            trace.record(event);
        }
        drainNow(state, trace);
    }
    state.counters["dropped"] = static_cast<double>(trace.dropped());
}
BENCHMARK(recordOnly);

}  // namespace

BENCHMARK_MAIN();
