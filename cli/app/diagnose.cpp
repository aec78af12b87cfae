// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/exit_codes.hpp"
#include "app/file_roles.hpp"
#include "app/ledger_commands.hpp"
#include "app/log.hpp"
#include "app/output_folders.hpp"
#include "diagnose/chrome_trace.hpp"
#include "diagnose/page.hpp"
#include "diagnose/text.hpp"
#include "image/atomic_file.hpp"

namespace sluice::cli {
namespace {

/// Roles and folders of the two outputs; kExitOk, or the code to end with.
int prepare(const DiagnoseOptions& options, FileRoles& roles, OutputFolders& folders) {
    roles.add("the log", options.log);
    for (const auto& [role, path] :
         {std::pair{"the trace (--trace)", options.trace}, {"the page (--html)", options.html}}) {
        if (path.empty()) {
            continue;
        }
        if (const Status status = roles.addOutput(role, path); !status) {
            logError(status.error());
            return kExitUsage;
        }
        if (const Status status = folders.prepare(path); !status) {
            logError(status.error());
            return kExitInternal;
        }
    }
    return kExitOk;
}

PageRange pageRange(const DiagnoseOptions& options) {
    if (!options.frames) {
        return {};
    }
    constexpr std::int64_t kMost = 0xFFFFFFFF;
    return {static_cast<std::uint32_t>(std::clamp<std::int64_t>(options.frames->first, 0, kMost)),
            static_cast<std::uint32_t>(std::clamp<std::int64_t>(options.frames->last, 0, kMost))};
}

/// Frames that the log does not have are not shown as if nothing had happened in them.
Status checkFrames(const DiagnoseOptions& options, const Diagnosis& diagnosis) {
    const std::vector<ledger::FrameReport>& frames = diagnosis.report.frames;
    const auto missing = [&](const char* option, const std::string& asked) {
        const std::string has = frames.empty()
                                    ? std::string("has no frames")
                                    : fmt::format("has frames {} to {}", frames.front().frame, frames.back().frame);
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, option,
                     fmt::format("{} {}, {} was asked for", options.log, has, asked),
                     fmt::format("leave {} out, or name what is there", option)};
    };
    if (options.frame && std::ranges::find(frames, *options.frame, &ledger::FrameReport::frame) == frames.end()) {
        return missing("--frame", std::to_string(*options.frame));
    }
    if (options.frames && (frames.empty() || options.frames->first < frames.front().frame ||
                           options.frames->last > frames.back().frame)) {
        return missing("--frames", fmt::format("{}..{}", options.frames->first, options.frames->last));
    }
    return {};
}

}  // namespace

int diagnose(const DiagnoseOptions& options) {
    FileRoles roles;
    OutputFolders folders;
    if (const int code = prepare(options, roles, folders); code != kExitOk) {
        return code;
    }
    const Result<Diagnosis> read = diagnoseLog(options.log);
    if (!read) {
        logError(read.error());
        return kExitBadInput;
    }
    const Diagnosis& diagnosis = read.value();
    if (diagnosis.recording.events.empty()) {
        // Not clean: nothing was looked at.
        const bool cut = diagnosis.recording.summary.end == ledger::End::Truncated;
        logError(
            {SLUICE_ERROR_INVALID_ARGUMENT, options.log,
             fmt::format("there is nothing to judge: no event{}", cut ? ", the log was cut off" : " was logged"),
             cut ? "record it anew; what was flushed or closed survives" : "log signals, waits, reads and writes"});
        return kExitBadInput;
    }
    if (const Status status = checkFrames(options, diagnosis); !status) {
        logError(status.error());
        return kExitUsage;
    }
    if (options.json) {
        fmt::print("{}\n", diagnosisJson(diagnosis).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else if (!options.quiet) {
        const TextOptions text{options.all ? diagnosis.findings.size() : TextOptions{}.per_kind, options.frame};
        fmt::print("{}", diagnosisText(diagnosis, text));
    }
    if (!options.trace.empty()) {
        if (const Status status = writeTextFile(options.trace, diagnosisTrace(diagnosis)); !status) {
            logError(status.error());
            return kExitInternal;
        }
    }
    if (!options.html.empty()) {
        if (const Status status = writeTextFile(options.html, diagnosisPage(diagnosis, pageRange(options))); !status) {
            logError(status.error());
            return kExitInternal;
        }
    }
    return diagnosis.clean() ? kExitOk : kExitFindings;
}

}  // namespace sluice::cli
