// SPDX-License-Identifier: MIT
#include "app/output_folders.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace sluice::cli {
namespace {

constexpr const char* kRemedy = "choose a folder that you may write to";

/// Creating a file is the only answer that is true on read-only mounts, under quotas and for root alike.
Status tryFolder(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const std::filesystem::path probe = folder / fmt::format(".sluice-probe-{}", getpid());
    const int fd = open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd < 0) {
        return Error{SLUICE_ERROR_INTERNAL, path.string(),
                     fmt::format("cannot be written: {}", std::generic_category().message(errno)), kRemedy};
    }
    close(fd);
    unlink(probe.c_str());
    return {};
}

}  // namespace

OutputFolders::~OutputFolders() {
    std::reverse(made_.begin(), made_.end());  // the innermost first
    for (const std::filesystem::path& folder : made_) {
        (void)rmdir(folder.c_str());  // fails, as it should, if something is in it
    }
}

Status OutputFolders::makeFolder(const std::filesystem::path& path, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> missing;
    std::error_code failure;
    for (std::filesystem::path at = folder; !at.empty() && !std::filesystem::exists(at, failure) && !failure;
         at = at.parent_path()) {
        missing.push_back(at);
    }
    std::reverse(missing.begin(), missing.end());  // clang 14 cannot compile libstdc++'s std::views::reverse
    for (const std::filesystem::path& at : missing) {
        if (std::filesystem::create_directory(at, failure)) {
            made_.push_back(at);
        }
        if (failure) {
            break;
        }
    }
    if (failure) {
        return Error{SLUICE_ERROR_INTERNAL, path.string(),
                     fmt::format("cannot create its folder: {}", failure.message()), kRemedy};
    }
    return {};
}

Status OutputFolders::prepare(const std::filesystem::path& path) {
    std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (folder != tried_) {
        if (Status status = makeFolder(path, folder); !status) {
            return status;
        }
        if (Status status = tryFolder(path, folder); !status) {
            return status;
        }
        tried_ = std::move(folder);
    }
    std::error_code ignored;
    const std::filesystem::file_status there = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
        return Error{SLUICE_ERROR_INTERNAL, path.string(),
                     std::filesystem::is_directory(there) ? "is a folder" : "is a pipe or a device",
                     "choose another name for the output"};
    }
    return {};
}

}  // namespace sluice::cli
