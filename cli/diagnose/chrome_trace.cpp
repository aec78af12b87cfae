// SPDX-License-Identifier: MIT
#include "diagnose/chrome_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace sluice::cli {
namespace {

using ledger::EventKind;
using ledger::kNone;

/// A JSON string; bytes that are not UTF-8 become U+FFFD.
std::string jsonString(std::string_view text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

class Writer {
  public:
    explicit Writer(const Diagnosis& d) : d_(d), origin_(d.recording.summary.first_ns) {}

    std::string write() {
        text_ = fmt::format(R"({{"displayTimeUnit":"ms","otherData":{{"clock":"CLOCK_MONOTONIC","origin_ns":"{}"}},)",
                            origin_);
        text_ += "\n\"traceEvents\":[\n";
        put(R"({{"ph":"M","pid":1,"name":"process_name","args":{{"name":{}}}}})", jsonString(d_.log));
        for (std::size_t actor = 0; actor < d_.recording.actors.size(); ++actor) {
            put(R"({{"ph":"M","pid":1,"tid":{},"name":"thread_name","args":{{"name":{}}}}})", actor + 1,
                jsonString(d_.recording.actors[actor].name));
            put(R"({{"ph":"M","pid":1,"tid":{0},"name":"thread_sort_index","args":{{"sort_index":{0}}}}})", actor + 1);
        }
        for (std::uint32_t i = 0; i < d_.recording.events.size(); ++i) {
            slice(i);
        }
        for (std::uint32_t i = 0; i < d_.recording.events.size(); ++i) {
            arrow(i);
        }
        for (const ledger::Finding& finding : d_.findings) {
            instant(finding);
        }
        return text_ + "\n]}\n";
    }

  private:
    template <typename... Args>
    void put(fmt::format_string<Args...> format, Args&&... args) {
        text_ += first_ ? "" : ",\n";
        first_ = false;
        fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    }
    /// Microseconds after the log's first event, with all nanoseconds kept: a double would round long logs.
    [[nodiscard]] std::string at(std::uint64_t ns) const {
        const std::uint64_t since = ns > origin_ ? ns - origin_ : 0;
        return length(since);
    }
    [[nodiscard]] static std::string length(std::uint64_t ns) { return fmt::format("{}.{:03}", ns / 1000, ns % 1000); }
    /// Threads count from 1: some viewers treat thread 0 as the idle thread.
    [[nodiscard]] std::uint32_t track(std::uint32_t event) const { return d_.recording.events[event].actor + 1; }

    void slice(std::uint32_t i) {
        const ledger::RecordedEvent& recorded = d_.recording.events[i];
        if (recorded.event.kind == EventKind::WaitBegin) {
            return;  // the Wait that closes it has the whole length
        }
        const std::string object = objectName(d_.recording, recorded);
        const std::string name =
            recorded.event.kind == EventKind::Frame
                ? fmt::format("frame {}", recorded.event.value)
                : fmt::format("{}{}{}", toString(recorded.event.kind), object.empty() ? "" : " ", object);
        put(R"({{"ph":"X","pid":1,"tid":{},"ts":{},"dur":{},"name":{},"cat":"{}","args":{{"sequence":{},"frame":{},"value":{},"logged_us":{}}}}})",
            track(i), at(d_.steps[i].begin_ns), length(d_.steps[i].length()), jsonString(name),
            toString(recorded.event.kind), i, recorded.frame, recorded.event.value, at(recorded.event.time_ns));
    }
    /// "bp":"e" binds an end to the slice that encloses it rather than to the next one.
    void arrow(std::uint32_t wait) {
        const std::uint32_t signal = d_.steps[wait].signal;
        if (signal == kNone) {
            return;
        }
        const std::string name = jsonString(fmt::format(
            "{} {}", d_.recording.syncs[d_.recording.events[wait].object].name, d_.recording.events[wait].event.value));
        put(R"({{"ph":"s","bp":"e","pid":1,"tid":{},"ts":{},"id":{},"name":{},"cat":"order"}})", track(signal),
            at(d_.steps[signal].begin_ns), wait + 1, name);
        put(R"({{"ph":"f","bp":"e","pid":1,"tid":{},"ts":{},"id":{},"name":{},"cat":"order"}})", track(wait),
            at(std::max(d_.steps[wait].begin_ns, std::min(d_.steps[signal].begin_ns, d_.steps[wait].end_ns))), wait + 1,
            name);
    }
    void instant(const ledger::Finding& finding) {
        const std::uint64_t sequence = finding.second.sequence;
        const std::uint32_t thread =
            sequence < d_.recording.events.size() ? track(static_cast<std::uint32_t>(sequence)) : 1;
        const ledger::FindingInfo& info = ledger::findingInfo(finding.kind);
        put(R"({{"ph":"i","s":"t","pid":1,"tid":{},"ts":{},"name":"{}","cat":"finding","args":{{"severity":"{}","sentence":{},"edge":{},"remedy":{}}}}})",
            thread, at(d_.timeOf(finding.second)), info.id, toString(info.severity), jsonString(finding.sentence),
            jsonString(finding.edge), jsonString(finding.remedy));
    }

    const Diagnosis& d_;
    std::uint64_t origin_;
    std::string text_;
    bool first_ = true;
};

}  // namespace

std::string diagnosisTrace(const Diagnosis& diagnosis) {
    return Writer(diagnosis).write();
}

}  // namespace sluice::cli
