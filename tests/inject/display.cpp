// SPDX-License-Identifier: MIT
#include "display.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
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
    std::array<int, 2> ready{};
    ASSERT_EQ(::pipe(ready.data()), 0);
    server_ = ::fork();
    ASSERT_GE(server_, 0);
    if (server_ == 0) {
        const std::string fd = std::to_string(ready[1]);
        const int quiet = ::open("/dev/null", O_RDWR);
        ::dup2(quiet, STDOUT_FILENO);
        ::dup2(quiet, STDERR_FILENO);
        ::execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "640x480x24", "-nolisten", "tcp",
                 static_cast<char*>(nullptr));
        ::_exit(127);
    }
    ::close(ready[1]);
    std::array<char, 16> number{};
    const ssize_t length = ::read(ready[0], number.data(), number.size() - 1);
    ::close(ready[0]);
    ASSERT_GT(length, 0) << "Xvfb did not start: install the packages of scripts/packages.txt";
    display_ = ":" + std::string(number.data(), static_cast<std::size_t>(length));
    display_.erase(display_.find_last_not_of(" \n") + 1);
}

void InjectTest::TearDown() {
    if (server_ > 0) {
        ::kill(server_, SIGTERM);
        ::waitpid(server_, nullptr, 0);
    }
    std::filesystem::remove_all(folder_);
}

Outcome InjectTest::run(const std::string& words) const {
    // The shell itself would report a signal; exec keeps it out of the way.
    const std::string command = fmt::format(
        "cd '{0}' && unset SLUICE_PLUGIN LD_PRELOAD && export DISPLAY={1} && exec {2} >'{0}/.out' 2>'{0}/.err'",
        folder_, display_, words);
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), slurp(folder_ + "/.out"),
            slurp(folder_ + "/.err")};
}

void InjectTest::write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << text;
}

}  // namespace sluice::inject::test
