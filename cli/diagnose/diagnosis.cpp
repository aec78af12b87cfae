// SPDX-License-Identifier: MIT
#include "diagnose/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/table.hpp"
#include "sluice/ledger/ledger.hpp"

namespace sluice::cli {
namespace {

using ledger::Severity;

void group(Diagnosis& diagnosis) {
    std::map<ledger::FindingKind, FindingGroup> kinds;
    for (std::size_t i = 0; i < diagnosis.findings.size(); ++i) {
        const ledger::Finding& finding = diagnosis.findings[i];
        FindingGroup& kind = kinds[finding.kind];
        kind.info = &ledger::findingInfo(finding.kind);
        kind.findings.push_back(i);
        kind.count += finding.count;
        kind.cost_ns += finding.cost_ns;
        ++(kind.info->severity == Severity::Error     ? diagnosis.errors
           : kind.info->severity == Severity::Warning ? diagnosis.warnings
                                                      : diagnosis.infos);
    }
    for (auto& [kind, one] : kinds) {
        std::ranges::stable_sort(one.findings, {}, [&](std::size_t i) { return diagnosis.findings[i].frame; });
        diagnosis.groups.push_back(std::move(one));
    }
    std::ranges::stable_sort(diagnosis.groups, std::ranges::greater{},
                             [](const FindingGroup& one) { return one.info->severity; });
}

/// Both at once, so that a log of any size is read once.
ledger::LogSink both(const ledger::LogSink& a, const ledger::LogSink& b) {
    ledger::LogSink sink;
    sink.actor = [&](auto... facts) { a.actor(facts...), b.actor(facts...); };
    sink.sync = [&](auto... facts) { a.sync(facts...), b.sync(facts...); };
    sink.resource = [&](auto... facts) { a.resource(facts...), b.resource(facts...); };
    sink.memory = [&](ledger::ObjectId id, const ledger::MemoryFacts& facts) { a.memory(id, facts); };
    sink.event = [&](const ledger::Event& event) { a.event(event), b.event(event); };
    return sink;
}

}  // namespace

std::uint64_t Diagnosis::timeOf(const ledger::Event& event) const {
    return event.sequence < steps.size() ? steps[event.sequence].begin_ns : event.time_ns;
}

Result<Diagnosis> diagnoseLog(const std::string& path) {
    ledger::Ledger ledger;
    ledger::Recorder recorder;
    const ledger::LogSink judging = sinkInto(ledger);
    const ledger::LogSink keeping = recorder.sink();
    const Result<ledger::LogSummary> summary = ledger::readLog(path, both(judging, keeping));
    if (!summary) {
        return summary.error();
    }
    ledger.finish(summary.value().end);
    Diagnosis diagnosis;
    diagnosis.log = path;
    diagnosis.recording = recorder.take(summary.value());
    diagnosis.findings = ledger.findings();
    diagnosis.unheard = ledger.unheard();
    diagnosis.dropped = ledger.findingsDropped();
    diagnosis.steps = ledger::schedule(diagnosis.recording);
    diagnosis.report = ledger::makeReport(diagnosis.recording, diagnosis.steps);
    group(diagnosis);
    return diagnosis;
}

std::string counted(std::uint64_t count, const char* one, const char* several) {
    return fmt::format("{} {}", formatCount(count), count == 1 ? one : several);
}

std::string formatTime(std::uint64_t ns) {
    const auto value = static_cast<double>(ns);
    return ns < 1000            ? fmt::format("{} ns", ns)
           : ns < 1'000'000     ? fmt::format("{:.1f} us", value / 1e3)
           : ns < 1'000'000'000 ? fmt::format("{:.2f} ms", value / 1e6)
                                : fmt::format("{:.2f} s", value / 1e9);
}

std::string verdict(const Diagnosis& diagnosis) {
    std::string text;
    const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (diagnosis.errors > 0) {
        add(counted(diagnosis.errors, "error", "errors"));
    }
    if (diagnosis.warnings > 0) {
        add(counted(diagnosis.warnings, "warning", "warnings"));
    }
    if (diagnosis.clean()) {
        add(diagnosis.unheard.empty() ? "clean" : "clean as far as it was told");
    }
    if (diagnosis.infos > 0) {
        add(counted(diagnosis.infos, "remark", "remarks"));
    }
    return text;
}

bool enteredByWait(const Diagnosis& diagnosis, const ledger::PathPart& part) {
    const std::uint32_t cause =
        part.entered_by == ledger::kNone ? ledger::kNone : diagnosis.steps[part.entered_by].cause;
    return cause != ledger::kNone && diagnosis.recording.events[cause].event.kind == ledger::EventKind::Signal;
}

std::string objectName(const ledger::Recording& recording, const ledger::RecordedEvent& event) {
    switch (ledger::objectUse(event.event)) {
        case ledger::ObjectUse::Sync:
            return recording.syncs[event.object].name;
        case ledger::ObjectUse::Resource:
            return recording.resources[event.object].name;
        case ledger::ObjectUse::Actor:
            return recording.actors[event.object].name;
        case ledger::ObjectUse::None:
            break;
    }
    const bool descriptor = event.event.kind == ledger::EventKind::FdOpen ||
                            event.event.kind == ledger::EventKind::FdGive ||
                            event.event.kind == ledger::EventKind::FdClose;
    return descriptor ? fmt::format("fd {}", event.event.object) : std::string{};
}

}  // namespace sluice::cli
