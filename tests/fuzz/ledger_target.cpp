// SPDX-License-Identifier: MIT
// Any bytes as a ledger log: read, judged, scheduled, reported, as `sluice diagnose` does.
#include <zlib.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "sluice/ledger/ledger.hpp"
#include "sluice/ledger/report.hpp"
#include "targets.hpp"

namespace sluice::fuzz {
namespace {

void require(bool condition, const char* promise) {
    if (!condition) {
        std::fprintf(stderr, "broken promise: %s\n", promise);
        std::abort();
    }
}

void checkReport(const ledger::Recording& recording) {
    const std::vector<ledger::Step> steps = ledger::schedule(recording);
    require(steps.size() == recording.events.size(), "every event has a step");
    for (std::size_t i = 0; i < steps.size(); ++i) {
        require(steps[i].begin_ns <= steps[i].end_ns, "no step ends before it begins");
        const std::uint32_t before = steps[i].previous;
        require(before == ledger::kNone || recording.events[before].actor == recording.events[i].actor,
                "what came before was the same actor's");
    }
    const ledger::Report report = ledger::makeReport(recording, steps);
    for (const ledger::FrameReport& frame : report.frames) {
        require(!frame.path.empty(), "a frame has a critical path");
        for (std::size_t i = 1; i < frame.path.size(); ++i) {
            require(frame.path[i - 1].end_ns == frame.path[i].begin_ns, "a critical path has no gap");
        }
    }
}

/// With the checksums that the bytes should have, so that what comes behind those checks is reached as well.
std::vector<std::byte> mended(std::span<const std::byte> bytes) {
    constexpr std::size_t kHeader = 16, kHead = 16, kSize = 4, kBodySum = 8, kHeadSum = 12;
    std::vector<std::byte> whole(bytes.begin(), bytes.end());
    const std::span<std::byte> log(whole);
    const auto sum = [](std::span<const std::byte> of) {
        return of.empty() ? 0U
                          : static_cast<std::uint32_t>(
                                ::crc32(0, reinterpret_cast<const Bytef*>(of.data()), static_cast<uInt>(of.size())));
    };
    for (std::size_t at = kHeader; at < log.size() && log.size() - at >= kHead;) {
        const std::span<std::byte> rest = log.subspan(at);
        std::uint32_t size = 0;
        std::memcpy(&size, rest.data() + kSize, sizeof(size));
        if (size <= rest.size() - kHead) {
            const std::uint32_t body = sum(rest.subspan(kHead, size));
            std::memcpy(rest.data() + kBodySum, &body, sizeof(body));
        }
        const std::uint32_t head = sum(rest.first(kHeadSum));
        std::memcpy(rest.data() + kHeadSum, &head, sizeof(head));
        at += kHead + size;
    }
    return whole;
}

void judgeLog(std::span<const std::byte> bytes) {
    ledger::Ledger judge;
    ledger::Recorder recorder;
    std::uint64_t events = 0;
    const ledger::LogSink judging = sinkInto(judge);
    const ledger::LogSink keeping = recorder.sink();
    ledger::LogSink sink;
    sink.actor = [&](ledger::ActorId id, ledger::ActorKind kind, std::string_view name) {
        judging.actor(id, kind, name);
        keeping.actor(id, kind, name);
    };
    sink.sync = [&](ledger::ObjectId id, ledger::SyncKind kind, std::string_view name, std::uint64_t initial,
                    std::uint16_t flags) {
        judging.sync(id, kind, name, initial, flags);
        keeping.sync(id, kind, name, initial, flags);
    };
    sink.resource = [&](ledger::ObjectId id, std::string_view name, std::uint32_t layout, ledger::ActorId owner) {
        judging.resource(id, name, layout, owner);
        keeping.resource(id, name, layout, owner);
    };
    sink.memory = judging.memory;
    sink.event = [&](const ledger::Event& event) {
        require(event.sequence == events++, "events are numbered by their place");
        judging.event(event);
        keeping.event(event);
    };
    const Result<ledger::LogSummary> summary = ledger::readLog(bytes, "fuzz", sink);
    if (!summary) {
        require(summary.error().code == SLUICE_ERROR_INVALID_ARGUMENT, "a bad log is an invalid argument");
        require(summary.error().message().starts_with("fuzz: at byte "), "an error names the log and the place");
    } else {
        require(summary.value().events == events, "the summary counts every event");
    }
    // What was read before an error counts too: `finish` must bear any beginning of a log.
    judge.finish(summary ? summary.value().end : ledger::End::Truncated);
    require(judge.eventsSeen() == events, "the ledger sees every event");
    for (const ledger::Finding& finding : judge.findings()) {
        require(finding.second.sequence < events, "a finding speaks of an event of the log");
        require(!finding.sentence.empty() && !finding.remedy.empty(), "a finding says what is wrong and what helps");
    }
    checkReport(recorder.take({}));
}

}  // namespace

void ledger_log(std::span<const std::byte> bytes) {
    judgeLog(bytes);
    judgeLog(mended(bytes));
}

}  // namespace sluice::fuzz
