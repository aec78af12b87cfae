// SPDX-License-Identifier: MIT
#include "diagnose/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "report/table.hpp"

namespace sluice::cli {
namespace {

using ledger::Distribution;
using ledger::FrameReport;

std::string header(const Diagnosis& d) {
    return fmt::format(
        "{}: {}\n{} of {} in {}{}\n", d.log, verdict(d), counted(d.recording.events.size(), "event", "events"),
        counted(d.recording.actors.size(), "actor", "actors"), counted(d.report.frames.size(), "frame", "frames"),
        d.recording.summary.end == ledger::End::Closed ? "" : "; the log was cut off, not closed");
}

std::string unheardText(const Diagnosis& d) {
    std::string text;
    for (const ledger::Unheard& one : d.unheard) {
        text += fmt::format("not judged{}: {}\n",
                            one.since_frame == 0 ? "" : fmt::format(", from frame {} on", one.since_frame), one.why);
    }
    return text;
}

std::string groupTable(const Diagnosis& d) {
    std::vector<std::vector<std::string>> rows{{"finding", "severity", "count", "first frame", "cost"}};
    for (const FindingGroup& group : d.groups) {
        rows.push_back({std::string(group.info->id), std::string(toString(group.info->severity)),
                        formatCount(group.count), std::to_string(d.findings[group.findings.front()].frame),
                        group.cost_ns > 0 ? formatTime(group.cost_ns) : "-"});
    }
    return formatTable(rows, {2, 3, 4});
}

std::string findingText(const ledger::Finding& finding) {
    const bool one = finding.first.sequence == finding.second.sequence;
    std::string text = fmt::format(
        "  frame {}, {}{}: {}\n", finding.frame,
        one ? fmt::format("event {}", finding.second.sequence)
            : fmt::format("events {} and {}", finding.first.sequence, finding.second.sequence),
        finding.count > 1 ? fmt::format(", seen {} times", formatCount(finding.count)) : "", finding.sentence);
    if (!finding.edge.empty()) {
        text += fmt::format("    edge    {}\n", finding.edge);
    }
    text += fmt::format("    remedy  {}\n", finding.remedy);
    if (finding.cost_ns > 0) {
        text += fmt::format("    cost    {}\n", formatTime(finding.cost_ns));
    }
    const char* label = "chain ";
    for (const std::string& line : finding.chain) {
        text += fmt::format("    {}  {}\n", std::exchange(label, "      "), line);
    }
    return text;
}

std::string groupText(const Diagnosis& d, const FindingGroup& group, std::size_t per_kind) {
    std::string text = fmt::format("{} ({}): {}\n", group.info->id, toString(group.info->severity), group.info->title);
    const std::size_t shown = std::min(per_kind, group.findings.size());
    for (std::size_t i = 0; i < shown; ++i) {
        text += findingText(d.findings[group.findings[i]]);
    }
    if (shown < group.findings.size()) {
        text += fmt::format("  {} more of this kind, to frame {}; --all prints them\n",
                            formatCount(group.findings.size() - shown), d.findings[group.findings.back()].frame);
    }
    return text;
}

std::string distributionText(const char* name, const Distribution& d) {
    return d.count == 0
               ? fmt::format("  {:<17} none\n", name)
               : fmt::format("  {:<17} min {}, median {}, p99 {}, max {} ({})\n", name, formatTime(d.min_ns),
                             formatTime(d.median_ns), formatTime(d.p99_ns), formatTime(d.max_ns), formatCount(d.count));
}

std::string overlapText(std::uint64_t achieved, std::uint64_t possible) {
    return possible == 0 ? "nothing that could have run side by side"
                         : fmt::format("{} of {} possible ({:.0f} %)", formatTime(achieved), formatTime(possible),
                                       100.0 * static_cast<double>(achieved) / static_cast<double>(possible));
}

std::string stallTable(const std::vector<ledger::Stall>& stalls) {
    std::vector<std::vector<std::string>> rows{{"who stood still", "for", "signalled by", "waits", "total", "longest"}};
    for (const ledger::Stall& stall : stalls) {
        rows.push_back({stall.waiting, stall.sync, stall.signaller.empty() ? "nobody" : stall.signaller,
                        formatCount(stall.waits), formatTime(stall.total_ns), formatTime(stall.longest_ns)});
    }
    return formatTable(rows, {3, 4, 5});
}

std::string frameText(const Diagnosis& d, const FrameReport& frame, const char* why) {
    std::string text = fmt::format("frame {}{}: {} long, {} stood still, overlap {}\ncritical path\n", frame.frame, why,
                                   formatTime(frame.end_ns - frame.begin_ns), formatTime(frame.stalled_ns),
                                   overlapText(frame.overlap_achieved_ns, frame.overlap_possible_ns));
    std::vector<std::vector<std::string>> rows{{"at", "for", "actor", "entered by"}};
    for (const ledger::PathPart& part : frame.path) {
        std::string entered = "its own work";
        if (part.entered_by != ledger::kNone) {
            const ledger::RecordedEvent& event = d.recording.events[part.entered_by];
            entered = enteredByWait(d, part)
                          ? fmt::format("wait for {} >= {}", objectName(d.recording, event), event.event.value)
                          : std::string("its submission");
        }
        rows.push_back({formatTime(part.begin_ns - frame.begin_ns), formatTime(part.end_ns - part.begin_ns),
                        d.recording.actors[part.actor].name, entered});
    }
    return text + formatTable(rows, {0, 1});
}

std::string reportText(const Diagnosis& d, const TextOptions& options) {
    const ledger::Report& report = d.report;
    std::string text = "where the time went (docs/diagnose.md has the definitions)\n";
    text += distributionText("frame", report.frame_span);
    text += distributionText("hand-off latency", report.hand_off);
    text += distributionText("wake-up latency", report.wake_up);
    text +=
        fmt::format("  {:<17} {}\n", "overlap", overlapText(report.overlap_achieved_ns, report.overlap_possible_ns));
    if (!report.stalls.empty()) {
        text += "\n" + stallTable(report.stalls);
    }
    const FrameReport* shown = nullptr;
    for (const FrameReport& frame : report.frames) {
        const bool longer = shown == nullptr || frame.end_ns - frame.begin_ns > shown->end_ns - shown->begin_ns;
        if (options.frame ? frame.frame == *options.frame : longer) {
            shown = &frame;
        }
    }
    if (shown != nullptr) {
        text += "\n" + frameText(d, *shown, options.frame ? "" : " (the longest)");
    }
    return text;
}

}  // namespace

std::string diagnosisText(const Diagnosis& d, const TextOptions& options) {
    std::string text = header(d) + unheardText(d);
    if (!d.groups.empty()) {
        text += "\n" + groupTable(d);
    }
    if (d.dropped > 0) {
        text += fmt::format("{} more were found and not kept\n", formatCount(d.dropped));
    }
    for (const FindingGroup& group : d.groups) {
        text += "\n" + groupText(d, group, options.per_kind);
    }
    return text + "\n" + reportText(d, options);
}

}  // namespace sluice::cli
