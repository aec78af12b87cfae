// SPDX-License-Identifier: MIT
#include "report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/table.hpp"
#include "sluice/format.hpp"

namespace sluice::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string_view formatName(std::uint32_t format) {
    const FormatInfo* info = findFormat(format);
    return info == nullptr ? "none" : info->name;
}

std::string_view encodingName(std::uint32_t encoding) {
    return encoding == SLUICE_DEPTH_LINEAR ? "linear" : "window";
}

std::vector<const HostRow*> hostRows(const RunSummary& s) {
    std::vector<const HostRow*> rows{&s.logic, &s.draw};
    if (s.has_renderer) {
        rows.insert(rows.end(), {&s.submit, &s.composite, &s.wait});
    }
    rows.push_back(&s.write);
    return rows;
}

std::string passTable(const RunSummary& s) {
    std::vector<std::vector<std::string>> rows{
        {"pass", "calls", "median ms", "elements up to", "", "bytes, each once"}};
    double total = 0.0;
    for (const PassRow& pass : s.passes) {
        total += pass.median_ms;
        rows.push_back({pass.name, fmt::format("{}", pass.calls), fmt::format("{:.3f}", pass.median_ms),
                        formatCount(pass.elements), pass.particles ? "particles" : "pixels",
                        formatBytes(static_cast<double>(pass.bytes))});
    }
    if (!s.passes.empty()) {
        rows.push_back({"all passes", "", fmt::format("{:.3f}", total), "", "", ""});
    }
    for (const HostRow* row : hostRows(s)) {
        rows.push_back(
            {row->name, fmt::format("{}", row->ms.size()), fmt::format("{:.3f}", median(row->ms)), "", "", ""});
    }
    return formatTable(rows, {1, 2, 3, 5});
}

Json rendererJson(const RunSummary& s) {
    if (!s.has_renderer) {
        return nullptr;
    }
    Json formats = Json::object();
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
        formats[std::string(toString(static_cast<SluiceImageRole>(role)))] = formatName(s.info.formats[role]);
    }
    return {{"name", s.renderer},
            {"plugin", s.plugin},
            {"device", s.info.capabilities.device_name},
            {"driver", s.info.capabilities.driver_name},
            {"driver_info", s.info.capabilities.driver_info},
            {"timeline", toString(static_cast<SluiceTimelineKind>(s.info.timeline))},
            {"timeline_reason", s.timeline_reason},
            {"image_sets", s.info.image_sets},
            {"formats", formats},
            {"host_depth_encoding", encodingName(s.info.host_depth_encoding)}};
}

Json passesJson(const std::vector<PassRow>& passes) {
    Json list = Json::array();
    for (const PassRow& pass : passes) {
        list.push_back({{"name", pass.name},
                        {"calls", pass.calls},
                        {"frames", pass.frames},
                        {"median_ms", pass.median_ms},
                        {"min_ms", pass.min_ms},
                        {"max_ms", pass.max_ms},
                        {"elements", pass.elements},
                        {"elements_are", pass.particles ? "particles" : "pixels"},
                        {"bytes", pass.bytes},
                        {"dispatches", pass.dispatches}});
    }
    return list;
}

std::string ledgerText(const LedgerSummary& s) {
    const std::string count = s.findings.empty()       ? "no finding"
                              : s.findings.size() == 1 ? "1 finding"
                                                       : fmt::format("{} findings", s.findings.size());
    std::string text;
    if (s.unchecked && s.unchecked->since_frame <= 1) {
        text = fmt::format("ledger: not checked: {}\n", s.unchecked->why);
    } else if (s.unchecked) {
        text = fmt::format("ledger: {} events, {}; off since frame {}: {}\n", formatCount(s.events), count,
                           s.unchecked->since_frame, s.unchecked->why);
    } else {
        text = fmt::format("ledger: {} events, {}\n", formatCount(s.events), count);
    }
    if (s.findings.empty()) {
        return text;
    }
    for (const ledger::Finding& finding : s.findings) {
        const ledger::FindingInfo& info = ledger::findingInfo(finding.kind);
        text += fmt::format("  {} {}{}: {} {}\n", ledger::toString(info.severity), info.id,
                            finding.count > 1 ? fmt::format(" (seen {} times)", finding.count) : std::string(),
                            finding.sentence, finding.remedy);
        for (const std::string& line : finding.chain) {
            text += fmt::format("    {}\n", line);
        }
    }
    if (s.dropped > 0) {
        text += fmt::format("  and {} more\n", s.dropped);
    }
    return text + "  sluice explain-finding ID tells more\n";
}

Json ledgerJson(const std::optional<LedgerSummary>& s) {
    if (!s) {
        return nullptr;
    }
    Json findings = Json::array();
    for (const ledger::Finding& finding : s->findings) {
        const ledger::FindingInfo& info = ledger::findingInfo(finding.kind);
        findings.push_back({{"id", info.id},
                            {"severity", ledger::toString(info.severity)},
                            {"frame", finding.frame},
                            {"count", finding.count},
                            {"cost_ns", finding.cost_ns},
                            {"sentence", finding.sentence},
                            {"remedy", finding.remedy},
                            {"edge", finding.edge},
                            {"chain", finding.chain}});
    }
    Json unchecked = nullptr;
    if (s->unchecked) {
        unchecked = {{"since_frame", s->unchecked->since_frame}, {"why", s->unchecked->why}};
    }
    return {{"events", s->events},
            {"memory_bytes", s->memory_bytes},
            {"dropped", s->dropped},
            {"unchecked", unchecked},
            {"findings", findings}};
}

}  // namespace

std::string summaryText(const RunSummary& s) {
    const std::string fluid = s.has_renderer && s.frames_with_fluid < s.frames_written
                                  ? fmt::format(" ({} with fluid)", s.frames_with_fluid)
                                  : std::string();
    std::string text =
        fmt::format("{} of {} frames{}, {}x{}, {} particles of radius {:.5f} m\n", s.frames_written, s.frames.count(),
                    fluid, s.size.width, s.size.height, formatCount(s.particles), s.radius);
    if (s.has_renderer) {
        text += fmt::format("renderer  {} on {} ({})\n", s.renderer, s.info.capabilities.device_name,
                            s.info.capabilities.driver_name);
        text += fmt::format("timeline  {} [{}]\n", toString(static_cast<SluiceTimelineKind>(s.info.timeline)),
                            s.timeline_reason);
        std::string formats;
        for (std::uint32_t role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
            if (s.info.formats[role] != SLUICE_FORMAT_NONE) {
                formats += fmt::format("{}{} {}", formats.empty() ? "" : ", ",
                                       toString(static_cast<SluiceImageRole>(role)), formatName(s.info.formats[role]));
            }
        }
        text += fmt::format("formats   {}; {} depth; {} image sets\n", formats,
                            encodingName(s.info.host_depth_encoding), s.info.image_sets);
    } else {
        text += "renderer  none: frames without fluid\n";
    }
    if (s.live) {
        text += liveText(*s.live);
    }
    text += "\n" + passTable(s) + "\n";
    text +=
        fmt::format("CPU copies of shared images in the frame loop: {} bytes. Read back for files: {}. Uploaded: {}.\n",
                    s.copies.shared_images, formatBytes(static_cast<double>(s.copies.readback)),
                    formatBytes(static_cast<double>(s.uploaded_bytes)));
    if (s.validation_messages > 0) {
        text += fmt::format("validation messages: {}\n", s.validation_messages);
    }
    if (s.ledger) {
        text += ledgerText(*s.ledger);
    }
    if (!s.files.empty()) {
        text += fmt::format("wrote {}", s.files.front());
        text += s.files.size() > 1 ? fmt::format(" ... {} ({} files)\n", s.files.back(), s.files.size()) : "\n";
    }
    for (const std::string& problem : s.problems) {
        text += fmt::format("problem: {}\n", problem);
    }
    return text;
}

nlohmann::ordered_json summaryJson(const RunSummary& s) {
    Json host = Json::array();
    for (const HostRow* row : hostRows(s)) {
        host.push_back({{"name", row->name},
                        {"calls", row->ms.size()},
                        {"median_ms", median(row->ms)},
                        {"max_ms", maximum(row->ms)}});
    }
    return {{"sluice", SLUICE_VERSION},
            {"scene", s.scene},
            {"size", {s.size.width, s.size.height}},
            {"frames",
             {{"first", s.frames.first},
              {"last", s.frames.last},
              {"written", s.frames_written},
              {"with_fluid", s.frames_with_fluid}}},
            {"particles", {{"count", s.particles}, {"radius", s.radius}}},
            {"renderer", rendererJson(s)},
            {"passes", passesJson(s.passes)},
            {"host", host},
            {"bytes",
             {{"cpu_copied_shared_images", s.copies.shared_images},
              {"read_back_for_files", s.copies.readback},
              {"uploaded", s.uploaded_bytes}}},
            {"validation_messages", s.validation_messages},
            {"trace_events_dropped", s.trace_dropped},
            {"simulation", s.live ? liveJson(*s.live) : Json(nullptr)},
            {"ledger", ledgerJson(s.ledger)},
            {"files", s.files},
            {"problems", s.problems},
            {"exit_code", s.exit_code}};
}

}  // namespace sluice::cli
