// SPDX-License-Identifier: MIT
// A virtual X server, and programs run in it, bare and injected.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "x_server.hpp"

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
    /// A program that does not end by itself, until `watch` has seen enough.
    Outcome runUntil(const std::string& words, const std::function<void()>& watch) const;
    Outcome bare(const std::string& words) const { return run("'" SLUICE_GL_TARGET "' " + words); }
    Outcome injected(const std::string& options, const std::string& words) const {
        return run("'" SLUICE_PROGRAM "' inject " + options + " -- '" SLUICE_GL_TARGET "' " + words);
    }
    /// A folder, and no server yet.
    void makeFolder();
    /// Its display; empty before SetUp().
    [[nodiscard]] std::string server() const { return server_ != nullptr ? server_->display() : std::string(); }
    void write(const std::string& name, const std::string& text) const;

  private:
    [[nodiscard]] std::string command(const std::string& words) const;
    [[nodiscard]] Outcome outcome(int status) const;
    std::string folder_;
    std::unique_ptr<sluice::test::XServer> server_;
};

}  // namespace sluice::inject::test
