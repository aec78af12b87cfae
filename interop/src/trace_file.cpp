// SPDX-License-Identifier: MIT
// A trace file that is there whole or not at all.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>

#include "sluice/fd.hpp"
#include "sluice/trace.hpp"

namespace sluice {

namespace {

/// errno of the write that failed, or nothing.
std::optional<int> writeAll(int fd, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(fd, text.data(), text.size());
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written < 0) {
            return errno;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return std::nullopt;
}

}  // namespace

Status writeChromeTraceFile(const std::string& path, const std::vector<TraceRecord>& records, std::uint64_t dropped) {
    const auto failure = [&path](std::string_view step, int code) {
        return Error{SLUICE_ERROR_INTERNAL, fmt::format("trace file '{}'", path),
                     fmt::format("{}: {} (errno {})", step, std::generic_category().message(code), code),
                     "give a path in a writable folder with room on its disk"};
    };
    std::ostringstream text;
    writeChromeTrace(text, records, dropped);

    // In the same folder, because rename works within one file system only; the process id keeps two runs apart.
    const std::string temporary = fmt::format("{}.{}.partial", path, ::getpid());
    UniqueFd file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!file.valid()) {
        return failure("cannot create it", errno);
    }
    std::optional<int> code = writeAll(file.get(), text.view());
    // close(2) reports what a delayed write could not do, so it is checked here rather than left to the destructor.
    if (::close(file.release()) != 0 && !code) {
        code = errno;
    }
    if (!code && std::rename(temporary.c_str(), path.c_str()) == 0) {
        return {};
    }
    const Error error = code ? failure("cannot write it", *code) : failure("cannot rename it into place", errno);
    ::unlink(temporary.c_str());
    return error;
}

}  // namespace sluice
