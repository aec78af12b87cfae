// SPDX-License-Identifier: MIT
#include "display.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace sluice::inject::test {

namespace {

std::string slurp(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

void InjectTest::makeFolder() {
    folder_ = (std::filesystem::temp_directory_path() / "sluice-inject-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder_.data()), nullptr);
}

void InjectTest::SetUp() {
    ASSERT_NO_FATAL_FAILURE(makeFolder());
    server_ = std::make_unique<sluice::test::XServer>();
    ASSERT_FALSE(server().empty()) << "Xvfb did not start: install the packages of scripts/packages.txt";
}

void InjectTest::TearDown() {
    std::filesystem::remove_all(folder_);
}

std::string InjectTest::command(const std::string& words) const {
    // The shell itself would report a signal; exec keeps it out of the way.
    return fmt::format(
        "cd '{0}' && unset SLUICE_PLUGIN LD_PRELOAD && export DISPLAY={1} && exec {2} >'{0}/.out' 2>'{0}/.err'",
        folder_, server(), words);
}

Outcome InjectTest::outcome(int status) const {
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), slurp(folder_ + "/.out"),
            slurp(folder_ + "/.err")};
}

Outcome InjectTest::run(const std::string& words) const {
    return outcome(std::system(command(words).c_str()));
}

Outcome InjectTest::runUntil(const std::string& words, const std::function<void()>& watch) const {
    const std::string line = command(words);
    const pid_t process = ::fork();
    if (process == 0) {
        ::execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
        ::_exit(127);
    }
    watch();
    int status = 0;
    if (process > 0) {
        ::kill(process, SIGTERM);
        ::waitpid(process, &status, 0);
    }
    return outcome(status);
}

void InjectTest::write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << text;
}

}  // namespace sluice::inject::test
