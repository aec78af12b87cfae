// SPDX-License-Identifier: MIT
#include "image/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>
#include <utility>

namespace sluice::cli {

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
    temporary_ = path_.parent_path() / fmt::format(".{}.partial-{}", path_.filename().string(), getpid());
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}

AtomicFile::~AtomicFile() {
    if (!temporary_.empty()) {
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
    }
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
    if (!path.has_filename()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(), "has no file name", "name a file to write"};
    }
    if (path.has_parent_path()) {
        std::error_code failure;
        std::filesystem::create_directories(path.parent_path(), failure);
        if (failure) {
            return Error{SLUICE_ERROR_INTERNAL, path.string(),
                         fmt::format("cannot create its folder: {}", failure.message()),
                         "choose a folder that you may write to"};
        }
    }
    return AtomicFile(path);
}

Status AtomicFile::commit() {
    std::error_code failure;
    std::filesystem::rename(temporary_, path_, failure);
    if (failure) {
        return Error{SLUICE_ERROR_INTERNAL, path_.string(),
                     fmt::format("cannot be put in place: {}", failure.message()),
                     "is it a folder, or is the disk full?"};
    }
    temporary_.clear();
    return {};
}

Status writeTextFile(const std::filesystem::path& path, std::string_view text) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) {
        return file.error();
    }
    {
        std::ofstream stream(file.value().temporary(), std::ios::binary);
        stream << text;
        stream.close();
        if (!stream) {
            return Error{SLUICE_ERROR_INTERNAL, path.string(), "cannot be written", "is the disk full?"};
        }
    }
    return file.value().commit();
}

}  // namespace sluice::cli
