// SPDX-License-Identifier: MIT
#include "isolate/child.hpp"

#include <fcntl.h>
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
#include <exception>
#include <thread>

#include "isolate/detached_spawn.hpp"
#include "sluice/blocked_signals.hpp"
#include "sluice/isolate/above_streams.hpp"
#include "sluice/isolate/server.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

namespace {

/// Reaps it whenever the kernel lets go of it. Nothing of this process is touched, so nobody waits for that thread.
void leaveToReaper(pid_t pid, UniqueFd pidfd) {
    try {
        const BlockedSignals quiet;
        std::thread([pid, pidfd = std::move(pidfd)] {
            siginfo_t ended{};
            int failed = EINTR;
            while (pidfd.valid() && failed == EINTR) {
                failed = ::waitid(P_PIDFD, static_cast<id_t>(pidfd.get()), &ended, WEXITED) == 0 ? 0 : errno;
            }
            if (pidfd.valid() && failed != EINVAL) {  // that is a kernel before 5.4
                return;
            }
            int status = 0;
            while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
            }
        }).detach();
    } catch (const std::exception&) {
        // It stays a zombie until this process ends.
    }
}

/// Whether a program that this process starts would find `fd` open. What is close-on-exec there is no standard stream
/// but some file that was opened after the stream had been closed, the channel perhaps.
bool isHandedOn(int fd) {
    const int flags = ::fcntl(fd, F_GETFD);
    return flags >= 0 && (flags & FD_CLOEXEC) == 0;
}

/// This process, for one that is to end with it; none where the kernel has no such thing. Above the numbers that it is
/// given there.
UniqueFd thisProcess() {
    const UniqueFd own(static_cast<int>(::syscall(SYS_pidfd_open, ::getpid(), 0)));
    return own.valid() ? UniqueFd(::fcntl(own.get(), F_DUPFD_CLOEXEC, isolate::kHostFd + 1)) : UniqueFd();
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

bool ChildEnd::clean() const {
    return kind == Kind::Seen ? !killed : kind == Kind::Reaped && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool ChildEnd::late() const {
    return late_s > 0.0 && (kind == Kind::Stuck || (kind == Kind::Seen && killed) ||
                            (kind == Kind::Reaped && WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL));
}

std::string ChildEnd::text() const {
    if (late()) {
        const std::string said = fmt::format("did not end within {:g} s and was killed", late_s);
        return kind == Kind::Stuck ? said + ", but " + ChildEnd{kind, status, killed, after_kill_ns, 0.0}.text() : said;
    }
    switch (kind) {
        case Kind::Seen:
            return "has ended";
        case Kind::Unknown:
            return "has ended, how is not known";
        case Kind::Stuck:
            return fmt::format("has not ended {:.3f} s after SIGKILL, stuck in the kernel, and is left behind",
                               static_cast<double>(after_kill_ns) * 1e-9);
        case Kind::Reaped:
            break;
    }
    if (WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        const char* name = ::sigabbrev_np(number);
        return fmt::format("was killed by signal {} (SIG{})", number, name != nullptr ? name : "?");
    }
    return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

Child::~Child() {
    if (pid_ > 0) {
        static_cast<void>(reap(0));
    }
}

Status Child::start(const std::filesystem::path& program, const std::string& argument, const isolate::Channel& channel,
                    bool detached) {
    SpawnActions spawn;
    const UniqueFd host = detached ? thisProcess() : UniqueFd();
    detached_ = host.valid();
    // The channel first: where this process lacks a standard stream, it may be one of the three numbers.
    posix_spawn_file_actions_adddup2(&spawn.files, channel.fd(), isolate::kChannelFd);
    if (detached_) {
        posix_spawn_file_actions_adddup2(&spawn.files, host.get(), isolate::kHostFd);
    }
    if (!isHandedOn(STDIN_FILENO)) {
        posix_spawn_file_actions_addopen(&spawn.files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    }
    if (!isHandedOn(STDERR_FILENO)) {
        posix_spawn_file_actions_addopen(&spawn.files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    }
    posix_spawn_file_actions_adddup2(&spawn.files, STDERR_FILENO, STDOUT_FILENO);
    // Drivers and applications do not mark every descriptor of theirs close-on-exec.
    posix_spawn_file_actions_addclosefrom_np(&spawn.files, (detached_ ? isolate::kHostFd : isolate::kChannelFd) + 1);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&spawn.attributes, &none);
    posix_spawnattr_setflags(&spawn.attributes, POSIX_SPAWN_SETSIGMASK);
    std::array<std::string, 4> words{program.string(), detached_ ? "--host" : "--parent", std::to_string(::getpid()),
                                     argument};
    std::array<char*, 5> arguments{words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
    UniqueFd end;
    const int failed =
        detached_ ? spawnDetached({program.c_str(), &spawn.files, &spawn.attributes, arguments.data()}, pid_, end)
                  : ::posix_spawn(&pid_, program.c_str(), &spawn.files, &spawn.attributes, arguments.data(), environ);
    if (failed != 0) {
        pid_ = -1;
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("renderer process '{}'", program.string()),
                     fmt::format("cannot be started: {}", std::strerror(failed)),
                     "it belongs beside the program; without isolation none is needed"};
    }
    running_ = true;
    // Kernels before 5.3 have none, and sandboxes may forbid it; the end of the channel then has to do.
    pidfd_ = isolate::aboveStreams(detached_ ? std::move(end)
                                             : UniqueFd(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0))));
    return {};
}

void Child::kill() {
    const std::lock_guard lock(mutex_);
    if (running_) {
        sendKill();
    }
}

void Child::sendKill() const {
    // By number only where there is nothing better: somebody else of this process may have reaped it, and the number
    // is another's then.
    if (!pidfd_.valid() || ::syscall(SYS_pidfd_send_signal, pidfd_.get(), SIGKILL, nullptr, 0) != 0) {
        if (!pidfd_.valid() || errno == ENOSYS || errno == EPERM) {
            ::kill(pid_, SIGKILL);
        }
    }
}

bool Child::waited(ChildEnd& end) {
    if (detached_) {
        pollfd ended{pidfd_.get(), POLLIN, 0};
        end.kind = ChildEnd::Kind::Seen;
        return pidfd_.valid() ? ::poll(&ended, 1, 0) > 0 : ::kill(pid_, 0) != 0;
    }
    int status = 0;
    const pid_t found = watch_.wait ? watch_.wait(pid_, &status) : ::waitpid(pid_, &status, WNOHANG);
    if (found == pid_) {
        end.kind = ChildEnd::Kind::Reaped;
        end.status = status;
        return true;
    }
    return found < 0 && errno != EINTR;  // somebody else has reaped it
}

ChildEnd Child::reap(std::uint64_t grace_ns) {
    ChildEnd end;
    const std::uint64_t begin = monotonicNanoseconds();
    std::uint64_t killed = 0;
    for (bool readable = false;;) {
        {
            const std::lock_guard lock(mutex_);
            if (!running_ || waited(end)) {
                running_ = false;
                return end;
            }
            const std::uint64_t now = monotonicNanoseconds();
            if (now - begin >= grace_ns) {
                killed = killed == 0 ? now : killed;
                end.killed = true;
                end.late_s = static_cast<double>(grace_ns) * 1e-9;
                sendKill();
                if (now - killed >= watch_.after_kill_ns) {
                    running_ = false;
                    if (!detached_) {
                        leaveToReaper(pid_, pidfd_.duplicate());
                    }
                    end.kind = ChildEnd::Kind::Stuck;
                    end.after_kill_ns = watch_.after_kill_ns;
                    return end;
                }
            }
        }
        if (pidfd_.valid() && !readable) {
            pollfd ended{pidfd_.get(), POLLIN, 0};
            readable = ::poll(&ended, 1, 50) > 0;
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
}

}  // namespace sluice::host
