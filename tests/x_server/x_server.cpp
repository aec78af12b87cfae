// SPDX-License-Identifier: MIT
#include "x_server.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

namespace sluice::test {

XServer::XServer(const char* screen) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
        return;
    }
    // The server writes the number that it took to this descriptor. -noreset: one that begins anew after its last
    // program would turn the next one away.
    constexpr int kNumber = 9;
    posix_spawn_file_actions_t files{};
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[1], kNumber);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::array<std::string, 9> words{"Xvfb", "-displayfd", std::to_string(kNumber), "-screen", "0", screen, "-nolisten",
                                     "tcp",  "-noreset"};
    std::array<char*, 10> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) {
        arguments.at(i) = words.at(i).data();
    }
    if (::posix_spawnp(&process_, "Xvfb", &files, nullptr, arguments.data(), environ) != 0) {
        process_ = -1;
    }
    posix_spawn_file_actions_destroy(&files);
    ::close(ends[1]);
    std::string number;
    char letter = 0;
    pollfd wait{ends[0], POLLIN, 0};
    while (::poll(&wait, 1, 30'000) == 1 && ::read(ends[0], &letter, 1) == 1 && letter != '\n') {
        number += letter;
    }
    ::close(ends[0]);
    if (letter == '\n') {
        display_ = ":" + number;
    }
}

XServer::~XServer() {
    if (process_ > 0) {
        ::kill(process_, SIGTERM);
        ::waitpid(process_, nullptr, 0);
    }
}

}  // namespace sluice::test
