// SPDX-License-Identifier: MIT
// The page's data; page/page.js draws it.
#include "diagnose/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "diagnose/page_text.hpp"

namespace sluice::cli {
namespace {

using Json = nlohmann::ordered_json;
using ledger::kNone;

/// Numbers that a double cannot hold go as text.
Json number(std::uint64_t value) {
    return value <= (std::uint64_t{1} << 53U) ? Json(value) : Json(std::to_string(value));
}

PageRange bounded(const Diagnosis& d, PageRange range) {
    std::vector<std::uint32_t> frames;
    for (const ledger::FrameReport& frame : d.report.frames) {
        if (frame.frame >= range.first && frame.frame <= range.last) {
            frames.push_back(frame.frame);
        }
    }
    if (frames.size() <= kPageFrames) {
        return range;
    }
    std::uint32_t start = 0xFFFFFFFF;
    for (const ledger::Finding& finding : d.findings) {
        const bool remark = ledger::findingInfo(finding.kind).severity == ledger::Severity::Info;
        if (!remark && finding.frame >= frames.front()) {
            start = std::min(start, finding.frame);
        }
    }
    auto from = std::ranges::lower_bound(frames, start);
    // A few frames before the first finding, and as many as fit; the beginning when nothing was found.
    std::size_t first = from == frames.end() ? 0 : static_cast<std::size_t>(from - frames.begin());
    first = std::min(first > 2 ? first - 2 : 0, frames.size() - kPageFrames);
    return {frames[first], frames[first + kPageFrames - 1]};
}

class PageData {
  public:
    PageData(const Diagnosis& d, PageRange range) : d_(d), range_(range), origin_(d.recording.summary.first_ns) {}

    Json make() {
        for (std::uint32_t i = 0; i < d_.recording.events.size(); ++i) {
            const std::uint32_t frame = d_.recording.events[i].frame;
            if (frame == 0 || (frame >= range_.first && frame <= range_.last)) {
                place_[i] = static_cast<std::uint32_t>(kept_.size());
                kept_.push_back(i);
            }
        }
        const ledger::LogSummary& summary = d_.recording.summary;
        return {{"log", d_.log},
                {"verdict", verdict(d_)},
                {"clean", d_.clean()},
                {"closed", summary.end == ledger::End::Closed},
                {"totalEvents", d_.recording.events.size()},
                {"totalFrames", d_.report.frames.size()},
                {"dropped", d_.dropped},
                {"unheard", unheard()},
                {"actors", actors()},
                {"events", events()},
                {"frames", frames()},
                {"findings", findings()},
                {"stalls", stalls(d_.report.stalls)},
                {"handOff", distribution(d_.report.hand_off)},
                {"wakeUp", distribution(d_.report.wake_up)},
                {"frameSpan", distribution(d_.report.frame_span)},
                {"overlap", {d_.report.overlap_achieved_ns, d_.report.overlap_possible_ns}}};
    }

  private:
    [[nodiscard]] Json unheard() const {
        Json list = Json::array();
        for (const ledger::Unheard& one : d_.unheard) {
            list.push_back(one.why);
        }
        return list;
    }
    [[nodiscard]] std::uint64_t at(std::uint64_t ns) const { return ns > origin_ ? ns - origin_ : 0; }
    [[nodiscard]] Json placeOf(std::uint64_t event) const {
        const auto found = event < kNone ? place_.find(static_cast<std::uint32_t>(event)) : place_.end();
        return found == place_.end() ? Json(-1) : Json(found->second);
    }
    static Json distribution(const ledger::Distribution& d) {
        return {d.count, d.min_ns, d.median_ns, d.p99_ns, d.max_ns};
    }
    static Json stalls(const std::vector<ledger::Stall>& list) {
        Json rows = Json::array();
        for (const ledger::Stall& stall : list) {
            rows.push_back({stall.waiting, stall.sync, stall.signaller, stall.waits, stall.total_ns, stall.longest_ns});
        }
        return rows;
    }
    [[nodiscard]] Json actors() const {
        Json rows = Json::array();
        for (const ledger::RecordedActor& actor : d_.recording.actors) {
            rows.push_back({actor.name, toString(actor.kind)});
        }
        return rows;
    }
    /// [kind, actor, object, value, frame, begin, end, signal, sequence, state]; state 1: never satisfied, 2: timed
    /// out.
    [[nodiscard]] Json events() const {
        Json rows = Json::array();
        for (const std::uint32_t i : kept_) {
            const ledger::RecordedEvent& recorded = d_.recording.events[i];
            const ledger::Step& step = d_.steps[i];
            const bool wait = recorded.event.kind == ledger::EventKind::Wait;
            const bool timed_out = wait && (recorded.event.flags & ledger::kTimedOut) != 0;
            const bool open = wait && !timed_out && step.signal == kNone &&
                              recorded.event.value > d_.recording.syncs[recorded.object].initial;
            const bool idle =
                step.cause != kNone && d_.recording.events[step.cause].event.kind == ledger::EventKind::Submit;
            rows.push_back({toString(recorded.event.kind), recorded.actor, objectName(d_.recording, recorded),
                            number(recorded.event.value), recorded.frame, at(step.begin_ns), at(step.end_ns),
                            placeOf(step.signal), i, (timed_out ? 2 : (open ? 1 : 0)) + (idle ? 4 : 0)});
        }
        return rows;
    }
    /// [frame, begin, end, stalled, achieved, possible, [[actor, begin, end, entered by, 1 by a wait]], stalls,
    /// hand-off].
    [[nodiscard]] Json frames() const {
        Json rows = Json::array();
        for (const ledger::FrameReport& frame : d_.report.frames) {
            if (frame.frame < range_.first || frame.frame > range_.last) {
                continue;
            }
            Json path = Json::array();
            for (const ledger::PathPart& part : frame.path) {
                path.push_back({part.actor, at(part.begin_ns), at(part.end_ns), placeOf(part.entered_by),
                                enteredByWait(d_, part) ? 1 : 0});
            }
            rows.push_back({frame.frame, at(frame.begin_ns), at(frame.end_ns), frame.stalled_ns,
                            frame.overlap_achieved_ns, frame.overlap_possible_ns, std::move(path), stalls(frame.stalls),
                            distribution(frame.hand_off)});
        }
        return rows;
    }
    [[nodiscard]] Json findings() const {
        Json rows = Json::array();
        for (const FindingGroup& group : d_.groups) {
            for (const std::size_t i : group.findings) {
                const ledger::Finding& finding = d_.findings[i];
                rows.push_back({{"id", group.info->id},
                                {"severity", toString(group.info->severity)},
                                {"title", group.info->title},
                                {"frame", finding.frame},
                                {"count", finding.count},
                                {"sentence", finding.sentence},
                                {"edge", finding.edge},
                                {"remedy", finding.remedy},
                                {"cost", finding.cost_ns},
                                {"chain", finding.chain},
                                {"first", placeOf(finding.first.sequence)},
                                {"second", placeOf(finding.second.sequence)}});
            }
        }
        return rows;
    }

    const Diagnosis& d_;
    PageRange range_;
    std::uint64_t origin_;
    std::vector<std::uint32_t> kept_;                         ///< events on the page
    std::unordered_map<std::uint32_t, std::uint32_t> place_;  ///< their places there
};

/// JSON that may stand inside a script element: names come from strangers, and "</script>" must not end it.
std::string embedded(const Json& data) {
    std::string text;
    for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
        if (c == '<') {
            text += "\\u003c";
        } else {
            text.push_back(c);
        }
    }
    return text;
}

}  // namespace

std::string diagnosisPage(const Diagnosis& diagnosis, PageRange range) {
    const std::string_view page = pageText();
    constexpr std::string_view kPlace = "/*DATA*/";
    const std::size_t place = page.find(kPlace);
    std::string text(page.substr(0, place));
    text += embedded(PageData(diagnosis, bounded(diagnosis, range)).make());
    return text.append(page.substr(place + kPlace.size()));
}

}  // namespace sluice::cli
