// SPDX-License-Identifier: MIT
#include "diagnose/text.hpp"

namespace sluice::cli {
namespace {

using Json = nlohmann::ordered_json;

Json distributionJson(const ledger::Distribution& d) {
    return {{"count", d.count}, {"min", d.min_ns}, {"median", d.median_ns}, {"p99", d.p99_ns}, {"max", d.max_ns}};
}

Json stallsJson(const std::vector<ledger::Stall>& stalls) {
    Json list = Json::array();
    for (const ledger::Stall& stall : stalls) {
        list.push_back({{"waiting", stall.waiting},
                        {"sync", stall.sync},
                        {"signaller", stall.signaller.empty() ? Json() : Json(stall.signaller)},
                        {"waits", stall.waits},
                        {"total_ns", stall.total_ns},
                        {"longest_ns", stall.longest_ns}});
    }
    return list;
}

Json eventJson(const Diagnosis& d, const ledger::Event& event) {
    Json json{{"sequence", event.sequence}, {"kind", toString(event.kind)}};
    if (event.sequence < d.recording.events.size()) {
        const ledger::RecordedEvent& recorded = d.recording.events[event.sequence];
        json["actor"] = d.recording.actors[recorded.actor].name;
        json["object"] = objectName(d.recording, recorded);
        json["frame"] = recorded.frame;
    }
    json["value"] = event.value;
    const std::uint64_t origin = d.recording.summary.first_ns;
    json["time_ns"] = event.time_ns > origin ? event.time_ns - origin : 0;
    json["duration_ns"] = event.duration_ns;
    return json;
}

Json findingsJson(const Diagnosis& d) {
    Json list = Json::array();
    for (const FindingGroup& group : d.groups) {
        for (const std::size_t i : group.findings) {
            const ledger::Finding& finding = d.findings[i];
            list.push_back({{"id", group.info->id},
                            {"severity", toString(group.info->severity)},
                            {"frame", finding.frame},
                            {"count", finding.count},
                            {"sentence", finding.sentence},
                            {"edge", finding.edge},
                            {"remedy", finding.remedy},
                            {"cost_ns", finding.cost_ns},
                            {"chain", finding.chain},
                            {"first", eventJson(d, finding.first)},
                            {"second", eventJson(d, finding.second)}});
        }
    }
    return list;
}

Json framesJson(const Diagnosis& d) {
    const std::uint64_t origin = d.recording.summary.first_ns;
    const auto since = [origin](std::uint64_t time) { return time > origin ? time - origin : 0; };
    Json list = Json::array();
    for (const ledger::FrameReport& frame : d.report.frames) {
        Json path = Json::array();
        for (const ledger::PathPart& part : frame.path) {
            path.push_back({{"actor", d.recording.actors[part.actor].name},
                            {"begin_ns", since(part.begin_ns)},
                            {"end_ns", since(part.end_ns)},
                            {"entered_by", part.entered_by == ledger::kNone ? Json() : Json(part.entered_by)}});
        }
        list.push_back({{"frame", frame.frame},
                        {"begin_ns", since(frame.begin_ns)},
                        {"end_ns", since(frame.end_ns)},
                        {"stalled_ns", frame.stalled_ns},
                        {"overlap_achieved_ns", frame.overlap_achieved_ns},
                        {"overlap_possible_ns", frame.overlap_possible_ns},
                        {"hand_off_ns", distributionJson(frame.hand_off)},
                        {"wake_up_ns", distributionJson(frame.wake_up)},
                        {"stalls", stallsJson(frame.stalls)},
                        {"critical_path", std::move(path)}});
    }
    return list;
}

}  // namespace

Json diagnosisJson(const Diagnosis& d) {
    Json actors = Json::array();
    for (const ledger::RecordedActor& actor : d.recording.actors) {
        actors.push_back({{"name", actor.name}, {"kind", toString(actor.kind)}});
    }
    Json groups = Json::array();
    for (const FindingGroup& group : d.groups) {
        groups.push_back({{"id", group.info->id},
                          {"severity", toString(group.info->severity)},
                          {"title", group.info->title},
                          {"count", group.count},
                          {"cost_ns", group.cost_ns}});
    }
    Json unheard = Json::array();
    for (const ledger::Unheard& one : d.unheard) {
        unheard.push_back({{"since_frame", one.since_frame}, {"why", one.why}});
    }
    return {{"log", d.log},
            {"verdict", d.clean() ? "clean" : "findings"},
            {"closed", d.recording.summary.end == ledger::End::Closed},
            {"events", d.recording.events.size()},
            {"origin_ns", d.recording.summary.first_ns},
            {"actors", std::move(actors)},
            {"unheard", std::move(unheard)},
            {"errors", d.errors},
            {"warnings", d.warnings},
            {"remarks", d.infos},
            {"dropped", d.dropped},
            {"groups", std::move(groups)},
            {"findings", findingsJson(d)},
            {"report",
             {{"frame_ns", distributionJson(d.report.frame_span)},
              {"hand_off_ns", distributionJson(d.report.hand_off)},
              {"wake_up_ns", distributionJson(d.report.wake_up)},
              {"stalled_ns", d.report.stalled_ns},
              {"overlap_achieved_ns", d.report.overlap_achieved_ns},
              {"overlap_possible_ns", d.report.overlap_possible_ns},
              {"stalls", stallsJson(d.report.stalls)},
              {"frames", framesJson(d)}}}};
}

}  // namespace sluice::cli
