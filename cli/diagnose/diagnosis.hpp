// SPDX-License-Identifier: MIT
// What is known of a log: its contents, what the ledger found, where the time went. Everything that is printed or drawn
// comes from here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sluice/ledger/ledger.hpp"
#include "sluice/ledger/report.hpp"

namespace sluice::cli {

/// The findings of one kind.
struct FindingGroup {
    const ledger::FindingInfo* info = nullptr;
    std::vector<std::size_t> findings;  ///< into Diagnosis::findings, by frame
    std::uint64_t count = 0;            ///< with repeats
    std::uint64_t cost_ns = 0;
};

struct Diagnosis {
    std::string log;
    ledger::Recording recording;
    std::vector<ledger::Step> steps;
    ledger::Report report;
    std::vector<ledger::Finding> findings;
    std::vector<ledger::Unheard> unheard;               ///< actors for which the findings do not speak
    std::uint64_t dropped = 0;                          ///< found, but not kept
    std::vector<FindingGroup> groups;                   ///< errors first
    std::uint64_t errors = 0, warnings = 0, infos = 0;  ///< kept findings without their repeats

    /// Information alone leaves a log clean.
    [[nodiscard]] bool clean() const { return errors == 0 && warnings == 0; }
    /// Where the schedule has the event at which a finding showed; the time it was logged if it is not in the log.
    [[nodiscard]] std::uint64_t timeOf(const ledger::Event& event) const;
};

/// Reads the log once, into the ledger and into memory. The errors are readLog's.
[[nodiscard]] Result<Diagnosis> diagnoseLog(const std::string& path);

/// "error" of one, "errors" of several: "2 errors".
[[nodiscard]] std::string counted(std::uint64_t count, const char* one, const char* several);
/// "420 ns", "12.3 us", "4.56 ms", "1.23 s".
[[nodiscard]] std::string formatTime(std::uint64_t ns);
/// "clean", "clean as far as it was told" or "2 errors, 1 warning".
[[nodiscard]] std::string verdict(const Diagnosis& diagnosis);
/// Whether a part of a critical path began when a wait was satisfied, rather than when work was submitted or at the
/// start.
[[nodiscard]] bool enteredByWait(const Diagnosis& diagnosis, const ledger::PathPart& part);
/// The object of an event by name; "fd 7" for descriptors; empty where the event has none.
[[nodiscard]] std::string objectName(const ledger::Recording& recording, const ledger::RecordedEvent& event);

}  // namespace sluice::cli
