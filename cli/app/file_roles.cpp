// SPDX-License-Identifier: MIT
#include "app/file_roles.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <system_error>
#include <vector>

namespace sluice::cli {
namespace {

/// Every key under which `path` is known. Inodes find hard links and file systems that ignore case.
std::vector<std::string> keysOf(const std::filesystem::path& path) {
    std::error_code failure;
    std::filesystem::path place = std::filesystem::weakly_canonical(std::filesystem::absolute(path, failure), failure);
    if (failure) {
        place = path.lexically_normal();
    }
    std::vector<std::string> keys{"at " + place.string()};
    struct stat info {};
    if (stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode)) {
        keys.push_back(fmt::format("inode {} of {}", info.st_ino, info.st_dev));
    }
    return keys;
}

}  // namespace

void FileRoles::add(const std::string& role, const std::filesystem::path& path) {
    for (std::string& key : keysOf(path)) {
        roles_.emplace(std::move(key), role);
    }
}

Status FileRoles::check(const std::string& role, const std::filesystem::path& path) const {
    for (const std::string& key : keysOf(path)) {
        if (const auto found = roles_.find(key); found != roles_.end()) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(),
                         fmt::format("would be {} and {} at once", found->second, role),
                         "choose another name for the output"};
        }
    }
    return {};
}

Status FileRoles::addOutput(const std::string& role, const std::filesystem::path& path) {
    if (Status status = check(role, path); !status) {
        return status;
    }
    add(role, path);
    return {};
}

}  // namespace sluice::cli
