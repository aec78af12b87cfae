// SPDX-License-Identifier: MIT
// A virtual X server, and programs run in it, bare and injected.
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <string>

namespace sluice::inject::test {

struct Outcome {
    int code = -1;  ///< 128 + signal if one ended it
    std::string out, err;
};

/// Every test has a server of its own, and its folder as the working directory of its programs.
class InjectTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;
    /// Shell words.
    Outcome run(const std::string& words) const;
    Outcome bare(const std::string& words) const { return run("'" SLUICE_GL_TARGET "' " + words); }
    Outcome injected(const std::string& options, const std::string& words) const {
        return run("'" SLUICE_PROGRAM "' inject " + options + " -- '" SLUICE_GL_TARGET "' " + words);
    }
    /// A folder, and no server yet.
    void makeFolder();
    void write(const std::string& name, const std::string& text) const;

  private:
    std::string folder_, display_;
    pid_t server_ = -1;
};

}  // namespace sluice::inject::test
