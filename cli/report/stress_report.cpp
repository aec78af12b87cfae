// SPDX-License-Identifier: MIT
#include "report/stress_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/table.hpp"

namespace sluice::cli {
namespace {

using stress::Combination;
using stress::Fault;
using stress::Row;

double rate(const Row& row) {
    return row.seconds > 0.0 ? static_cast<double>(row.handoffs) / row.seconds : 0.0;
}

std::string verdict(const Row& row) {
    if (row.refused_here) {
        return "not here";  // in the JSON
    }
    if (row.failure) {
        return "FAILED";
    }
    if (row.interrupted) {
        return "interrupted";
    }
    const Fault fault = row.combination.fault;
    return fault == Fault::None ? "clean" : fault == Fault::Delay ? "borne" : "seen";
}

nlohmann::ordered_json counts(const stress::FaultCounts& one) {
    return {{"injected", one.injected},
            {"by_pixels", one.by_pixels},
            {"by_ledger", one.by_ledger},
            {"by_both", one.by_both},
            {"unseen", one.unseen}};
}

nlohmann::ordered_json names(const Combination& one) {
    return {{"pattern", toString(one.pattern)},
            {"backend", toString(one.backend)},
            {"resource", toString(one.resource)},
            {"topology", toString(one.topology)},
            {"fault", toString(one.fault)}};
}

}  // namespace

std::string stressText(const std::vector<Row>& rows, std::uint64_t seed) {
    const bool faults =
        std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.combination.fault != Fault::None; });
    std::vector<std::vector<std::string>> table{
        {"pattern", "backend", "resource", "topology", "hand-offs", "per s", "checks", "bad texels", "findings"}};
    std::vector<std::size_t> right{4, 5, 6, 7, 8};
    if (faults) {
        for (const char* head : {"fault", "injected", "by pixels", "by ledger", "by both", "by none"}) {
            table.front().emplace_back(head);
        }
        right.insert(right.end(), {10, 11, 12, 13, 14});
    }
    table.front().emplace_back("verdict");
    std::uint64_t handoffs = 0;
    std::uint64_t failures = 0;
    std::uint64_t ran = 0;
    double seconds = 0.0;
    for (const Row& row : rows) {
        if (row.refused_here) {
            continue;  // it has no numbers; stderr says why
        }
        ++ran;
        failures += row.failure ? 1U : 0U;
        const Combination& one = row.combination;
        std::vector<std::string> line{std::string(toString(one.pattern)),
                                      std::string(toString(one.backend)),
                                      std::string(toString(one.resource)),
                                      std::string(toString(one.topology)),
                                      formatCount(row.handoffs),
                                      fmt::format("{:.0f}", rate(row)),
                                      formatCount(row.checks),
                                      formatCount(row.bad_texels),
                                      formatCount(row.findings)};
        if (faults) {
            line.emplace_back(toString(one.fault));
            for (const std::uint64_t count : {row.faults, row.by_pixels, row.by_ledger, row.by_both, row.unseen}) {
                line.push_back(formatCount(count));
            }
        }
        line.push_back(verdict(row));
        table.push_back(std::move(line));
        handoffs += row.handoffs;
        seconds += row.seconds;
    }
    if (ran == 0 && !rows.empty()) {
        return fmt::format("no combination ran; seed {}\n", seed);
    }
    return formatTable(table, right) + fmt::format("{} hand-offs in {:.1f} s, {} of {} combinations failed; seed {}\n",
                                                   formatCount(handoffs), seconds, failures, ran, seed);
}

nlohmann::ordered_json stressJson(const std::vector<Row>& rows, const stress::Matrix& matrix,
                                  const stress::Options& options) {
    nlohmann::ordered_json document;
    document["seed"] = options.seed;
    document["combinations"] = nlohmann::ordered_json::array();
    for (const Row& row : rows) {
        nlohmann::ordered_json one = names(row.combination);
        one["handoffs"] = row.handoffs;
        one["seconds"] = row.seconds;
        one["per_second"] = rate(row);
        one["checks"] = row.checks;
        one["bad_texels"] = row.bad_texels;
        one["findings"] = row.findings;
        one["faults"] = {{"injected", row.faults}, {"by_pixels", row.by_pixels}, {"by_ledger", row.by_ledger},
                         {"by_both", row.by_both}, {"unseen", row.unseen},       {"refused_by_guard", row.refused}};
        one["faults"]["gl"] = counts(row.at[0]);
        one["faults"]["vulkan"] = counts(row.at[1]);
        one["told"] = row.told;
        one["verdict"] = verdict(row);
        one["failure"] = row.failure ? nlohmann::ordered_json(*row.failure) : nlohmann::ordered_json();
        one["waits"] = row.chain;
        one["log"] = row.log;
        one["repeat"] = stress::commandLine(row.combination, options.seed, std::max<std::uint64_t>(1, row.handoffs));
        document["combinations"].push_back(std::move(one));
    }
    document["left_out"] = nlohmann::ordered_json::array();
    for (const stress::Skipped& skipped : matrix.skipped) {
        nlohmann::ordered_json one = names(skipped.combination);
        one["why"] = skipped.why;
        document["left_out"].push_back(std::move(one));
    }
    return document;
}

std::string failureText(const Row& row, std::uint64_t seed) {
    const Combination& one = row.combination;
    std::string text =
        fmt::format("sluice: error: stress {} {} {} {}: {}\n", toString(one.pattern), toString(one.backend),
                    toString(one.resource), toString(one.topology), row.failure.value_or(""));
    for (const std::string& line : row.chain) {
        text += "  " + line + "\n";
    }
    for (const std::string& line : row.told) {
        text += "  " + line + "\n";
    }
    text += "  again: " + stress::commandLine(one, seed, std::max<std::uint64_t>(1, row.handoffs)) + "\n";
    if (!row.log.empty()) {
        text += fmt::format("  log:   {} (sluice diagnose {} reads it)\n", row.log, row.log);
    } else if (!row.log_error.empty()) {
        text += "  log:   not kept: " + row.log_error + "\n";
    }
    return text;
}

}  // namespace sluice::cli
