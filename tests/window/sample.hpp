// SPDX-License-Identifier: MIT
// samples/window as a process, and what it wrote.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace window::test {

/// Runs in a folder of its own, which goes with it.
class Sample {
  public:
    /// `display` is put into DISPLAY; empty: there is none.
    Sample(const std::string& display, const std::vector<std::string>& arguments);
    Sample(const Sample&) = delete;
    Sample& operator=(const Sample&) = delete;
    ~Sample();

    /// The exit code, once it has ended; 128 and its signal if that ended it.
    [[nodiscard]] std::optional<int> ended();
    /// stdout and stderr together.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
    pid_t process_ = 0;
    std::optional<int> code_;
};

}  // namespace window::test
