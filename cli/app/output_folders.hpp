// SPDX-License-Identifier: MIT
// The places of outputs, made and tried before any work.
#pragma once

#include <filesystem>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::cli {

/// Remembers the folders that it makes; the destructor removes those that nothing was written into.
class OutputFolders {
  public:
    OutputFolders() = default;
    OutputFolders(const OutputFolders&) = delete;
    OutputFolders& operator=(const OutputFolders&) = delete;
    OutputFolders(OutputFolders&&) = delete;
    OutputFolders& operator=(OutputFolders&&) = delete;
    ~OutputFolders();

    /// Makes the folder of `path` if need be, and writes and removes a temporary file in it. An error, with the code
    /// SLUICE_ERROR_INTERNAL, if that fails or if something other than a file already has the name.
    [[nodiscard]] Status prepare(const std::filesystem::path& path);

  private:
    [[nodiscard]] Status makeFolder(const std::filesystem::path& path, const std::filesystem::path& folder);
    std::vector<std::filesystem::path> made_;
    std::filesystem::path tried_;  ///< the folder of the last call: most calls are about the same one
};

}  // namespace sluice::cli
