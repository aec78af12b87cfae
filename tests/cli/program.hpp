// SPDX-License-Identifier: MIT
// Running the real program in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace sluice::test {

struct Outcome {
    int code = -1;
    std::string out, err;
};

/// Every test gets an empty folder, the working directory of the program, removed afterwards.
class ProgramTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

    /// Runs `sluice` with shell words; stdout and stderr are captured. 128 + signal if it was killed.
    /// `wrapper` is a command that runs the program (timeout).
    Outcome run(const std::string& words, const std::string& wrapper = "") const;
    void write(const std::string& name, const std::string& bytes) const;
    /// A lattice of n^3 particles in [-0.5,0.5] x [0,1] x [-0.5,0.5] as .pos.
    void writeParticles(const std::string& name, unsigned n) const;
    /// A small scene whose particles are `particles`.
    void writeScene(const std::string& name, const std::string& particles, const std::string& more = "") const;
    [[nodiscard]] std::filesystem::path at(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(at(name)); }
    [[nodiscard]] std::string read(const std::string& name) const;
    /// Names in the folder, sorted.
    [[nodiscard]] std::vector<std::string> files() const;

  private:
    std::filesystem::path folder_;
};

}  // namespace sluice::test
