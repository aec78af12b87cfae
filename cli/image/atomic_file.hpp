// SPDX-License-Identifier: MIT
// A file that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

#include "sluice/result.hpp"

namespace sluice::cli {

/// A temporary path in the folder of the final one. commit() renames it; otherwise the destructor removes it.
class AtomicFile {
  public:
    /// Creates the folder if need be. Touches no file yet.
    [[nodiscard]] static Result<AtomicFile> create(const std::filesystem::path& path);
    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Where to write.
    [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
    /// Moves the written file into place, over an older one.
    [[nodiscard]] Status commit();

  private:
    explicit AtomicFile(std::filesystem::path path);
    std::filesystem::path path_, temporary_;
};

/// A text file, whole or not at all.
[[nodiscard]] Status writeTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace sluice::cli
