// SPDX-License-Identifier: MIT
#include "app/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "app/user_words.hpp"

namespace sluice::cli {
namespace {

spdlog::level::level_enum spdlogLevel(SluiceLogLevel level) {
    switch (level) {
        case SLUICE_LOG_DEBUG:
            return spdlog::level::debug;
        case SLUICE_LOG_INFO:
            return spdlog::level::info;
        case SLUICE_LOG_WARNING:
            return spdlog::level::warn;
        case SLUICE_LOG_ERROR:
            break;
    }
    return spdlog::level::err;
}

}  // namespace

void startLog(int verbosity, bool quiet) {
    auto logger = std::make_shared<spdlog::logger>("sluice", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    // A progress bar may stand in the line: wipe it first.
    logger->set_pattern(isatty(STDERR_FILENO) == 1 ? "\r\033[Ksluice: %^%l%$: %v" : "sluice: %l: %v");
    if (quiet) {
        logger->set_level(spdlog::level::err);
    } else {
        logger->set_level(verbosity >= 2   ? spdlog::level::debug
                          : verbosity == 1 ? spdlog::level::info
                                           : spdlog::level::warn);
    }
    spdlog::set_default_logger(std::move(logger));
}

void log(SluiceLogLevel level, std::string_view message) {
    spdlog::default_logger_raw()->log(spdlogLevel(level), "{}", inUserWords(message));
}

void logError(const Error& error) {
    log(SLUICE_LOG_ERROR, error.message());
}

}  // namespace sluice::cli
