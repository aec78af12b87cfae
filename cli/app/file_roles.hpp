// SPDX-License-Identifier: MIT
// Which file plays which part, so that no output destroys an input or another output.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "sluice/result.hpp"

namespace sluice::cli {

/// The files of one run. Two paths are the same file if they lead to the same place once links and ".." are resolved,
/// or if both exist and share an inode. Roles read like "the scene file" or "the trace (--trace)".
class FileRoles {
  public:
    /// Inputs may coincide. A path that does not exist counts too.
    void add(const std::string& role, const std::filesystem::path& path);
    /// An error that names both roles and the path if the file already has a role. Code:
    /// SLUICE_ERROR_INVALID_ARGUMENT.
    [[nodiscard]] Status check(const std::string& role, const std::filesystem::path& path) const;
    /// check, then add.
    [[nodiscard]] Status addOutput(const std::string& role, const std::filesystem::path& path);

  private:
    std::map<std::string, std::string> roles_;  ///< by place and by inode
};

}  // namespace sluice::cli
