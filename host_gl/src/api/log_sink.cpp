// SPDX-License-Identifier: MIT
#include "api/log_sink.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <string>

namespace sluice::host {

LogSink logSink(const SluiceOptions& options) {
    if (options.log != nullptr) {
        return [log = options.log, user = options.log_user](SluiceLogLevel level, std::string_view text) {
            log(user, level, std::string(text).c_str());
        };
    }
    return [](SluiceLogLevel level, std::string_view text) {
        if (level < SLUICE_LOG_WARNING) {
            return;
        }
        // One write, so that lines of several threads stay lines. A stderr that is closed is the engine's wish.
        const std::string line = fmt::format("sluice: {}\n", text);
        [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
    };
}

}  // namespace sluice::host
