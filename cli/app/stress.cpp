// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/exit_codes.hpp"
#include "app/interrupt.hpp"
#include "app/log.hpp"
#include "app/output_folders.hpp"
#include "app/stress_command.hpp"
#include "report/stress_report.hpp"
#include "stress/plan.hpp"
#include "stress/run.hpp"

namespace sluice::cli {
namespace {

constexpr std::uint64_t kHandoffs = 20'000;  ///< in all, when nothing is said

/// What each of `count` combinations gets of the whole; the first ones get the remainder.
stress::Limit shareOf(const stress::Options& options, std::size_t count, std::size_t index) {
    if (options.seconds) {
        return {0, *options.seconds / static_cast<double>(count)};
    }
    const std::uint64_t all = options.handoffs.value_or(kHandoffs);
    return {std::max<std::uint64_t>(1, all / count + (index < all % count ? 1 : 0)), 0.0};
}

/// "all" backends are those that the stress test can drive.
void leaveOutUndrivable(stress::Matrix& matrix, const stress::Options& options) {
    const auto undrivable = [](const stress::Combination& one) {
        return one.backend == stress::Backend::Native || one.backend == stress::Backend::Binary;
    };
    if (!options.backend) {
        std::erase_if(matrix.runs, undrivable);
        std::erase_if(matrix.skipped, [&](const stress::Skipped& one) { return undrivable(one.combination); });
    }
}

}  // namespace

int stress(const stress::Options& options) {
    Result<stress::Matrix> meant = stress::matrixOf(options);
    if (!meant) {
        logError(meant.error());
        return kExitUsage;
    }
    stress::Matrix matrix = std::move(meant).value();
    leaveOutUndrivable(matrix, options);
    watchForInterrupt();
    OutputFolders folders;
    if (!options.log.empty()) {
        if (const Status status = folders.prepare(options.log); !status) {
            logError(status.error());
            return kExitInternal;
        }
    }
    std::string log = options.log.empty() ? fmt::format("stress-{}.sluicelog", options.seed) : options.log;
    std::vector<stress::Row> rows;
    std::map<std::string, std::size_t> refused;  ///< combinations by what forbids them here
    bool stuck = false;
    for (std::size_t i = 0; i < matrix.runs.size() && !interrupted() && !stuck; ++i) {
        const stress::Combination& one = matrix.runs[i];
        rows.push_back(stress::runCombination(one, options.seed, shareOf(options, matrix.runs.size(), i), log,
                                              [] { return interrupted(); }));
        const stress::Row& row = rows.back();
        stuck = row.stuck;
        if (row.refused_here) {
            ++refused[row.failure.value_or("")];  // of all combinations alike: said once
        } else if (row.failure) {
            fmt::print(stderr, "{}", failureText(row, options.seed));
        }
        log = row.log.empty() ? log : "";  // one log: of the first failure
    }
    for (const auto& [why, count] : refused) {
        fmt::print(stderr, "sluice: error: stress: {}; {} of {} combinations cannot run here\n", why, count,
                   matrix.runs.size());
    }
    if (options.json) {
        fmt::print("{}\n", stressJson(rows, matrix, options).dump(2));
    } else {
        fmt::print("{}", stressText(rows, options.seed));
    }
    bool failed = false;
    for (const stress::Row& row : rows) {
        failed |= row.failure.has_value();
    }
    const int code = interrupted() ? kExitInterrupted : failed ? kExitNoFluid : kExitOk;
    if (stuck) {
        (void)std::fflush(nullptr);
        std::_Exit(code);  // drivers would wait for the queue that never ends
    }
    return code;
}

}  // namespace sluice::cli
