// SPDX-License-Identifier: MIT
#include "isolate/child.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "sluice/isolate/server.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

namespace {

std::string howItEnded(int status) {
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        const char* name = ::sigabbrev_np(number);
        return fmt::format("was killed by signal {} (SIG{})", number, name != nullptr ? name : "?");
    }
    return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

/// Owns what posix_spawn reads.
struct SpawnActions {
    SpawnActions() {
        posix_spawn_file_actions_init(&files);
        posix_spawnattr_init(&attributes);
    }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;
    ~SpawnActions() {
        posix_spawn_file_actions_destroy(&files);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_t files{};
    posix_spawnattr_t attributes{};
};

}  // namespace

Child::~Child() {
    if (pid_ > 0) {
        bool clean = false;
        static_cast<void>(reap(0, clean));
    }
}

Status Child::start(const std::filesystem::path& program, const std::string& argument,
                    const isolate::Channel& channel) {
    SpawnActions spawn;
    posix_spawn_file_actions_adddup2(&spawn.files, STDERR_FILENO, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&spawn.files, channel.fd(), isolate::kChannelFd);
    // Drivers and applications do not mark every descriptor of theirs close-on-exec.
    posix_spawn_file_actions_addclosefrom_np(&spawn.files, isolate::kChannelFd + 1);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&spawn.attributes, &none);
    posix_spawnattr_setflags(&spawn.attributes, POSIX_SPAWN_SETSIGMASK);
    std::array<std::string, 4> words{program.string(), "--parent", std::to_string(::getpid()), argument};
    std::array<char*, 5> arguments{words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
    const int failed =
        ::posix_spawn(&pid_, program.c_str(), &spawn.files, &spawn.attributes, arguments.data(), environ);
    if (failed != 0) {
        pid_ = -1;
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("renderer process '{}'", program.string()),
                     fmt::format("cannot be started: {}", std::strerror(failed)),
                     "it belongs beside the program; without isolation none is needed"};
    }
    running_ = true;
    // Kernels before 5.3 have none, and sandboxes may forbid it; the end of the channel then has to do.
    pidfd_.reset(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
    return {};
}

void Child::kill() {
    const std::lock_guard lock(mutex_);
    if (running_) {
        ::kill(pid_, SIGKILL);
    }
}

std::string Child::reap(std::uint64_t grace_ns, bool& clean) {
    clean = false;
    const std::uint64_t begin = monotonicNanoseconds();
    for (;;) {
        {
            const std::lock_guard lock(mutex_);
            if (!running_) {
                return "has ended";
            }
            int status = 0;
            const pid_t found = ::waitpid(pid_, &status, WNOHANG);
            if (found == pid_) {
                running_ = false;
                clean = WIFEXITED(status) && WEXITSTATUS(status) == 0;
                return howItEnded(status);
            }
            if (found < 0 && errno != EINTR) {
                running_ = false;  // somebody else of this process has reaped it
                return "has ended, how is not known";
            }
            if (monotonicNanoseconds() - begin >= grace_ns) {
                ::kill(pid_, SIGKILL);
            }
        }
        if (pidfd_.valid()) {
            pollfd end{pidfd_.get(), POLLIN, 0};
            static_cast<void>(::poll(&end, 1, 50));
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
}

}  // namespace sluice::host
