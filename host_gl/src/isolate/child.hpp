// SPDX-License-Identifier: MIT
// One process that this one has started.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "sluice/fd.hpp"
#include "sluice/isolate/channel.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// How a Child learns that its process has ended, and how long it waits for what. For tests: nobody can make a process
/// that SIGKILL does not end.
struct ChildWatch {
    std::function<pid_t(pid_t, int*)> wait;          ///< as waitpid with WNOHANG; empty: that itself
    std::uint64_t after_kill_ns = 5'000'000'000ULL;  ///< what SIGKILL gets to be obeyed
    /// What one that has closed its channel gets for its exit handlers.
    std::uint64_t grace_ns = 10'000'000'000ULL;
    /// What calls give the log to be told of an end before them. It may be waiting for the very thread that calls.
    std::uint64_t telling_ns = 5'000'000'000ULL;
};

/// How a process ended, if it did.
struct ChildEnd {
    enum class Kind : std::uint8_t {
        Reaped,
        Seen,     ///< that it has, and no more: it was detached
        Unknown,  ///< somebody else of this process has reaped it
        Stuck     ///< SIGKILL has not ended it in time: it sits in a driver in the kernel
    };
    Kind kind = Kind::Unknown;
    int status = 0;                   ///< of waitpid, when Reaped
    bool killed = false;              ///< by reap()
    std::uint64_t after_kill_ns = 0;  ///< that were waited for it in vain, when Stuck
    double late_s = 0.0;              ///< the grace that it let pass, after which reap() has killed it; or 0

    /// It ended with exit code 0, as far as anybody knows.
    [[nodiscard]] bool clean() const;
    /// Killed by reap() itself, for its grace was over.
    [[nodiscard]] bool late() const;
    /// "was killed by signal 9 (SIGKILL)".
    [[nodiscard]] std::string text() const;
};

/// Owns a process: whoever lets go of it has killed and reaped it, or left it to a thread that does once the kernel
/// lets it go. The kernel ends a child with the thread that has started it (sluice/isolate/server.hpp, endWithHost), so
/// that thread must last as long as the process. A detached one is no child of this process: it watches it, and ends
/// with it.
class Child {
  public:
    explicit Child(ChildWatch watch = {}) : watch_(std::move(watch)) {}
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();

    /// Starts `program --parent PID argument`, detached `program --host PID argument`, with `channel` as descriptor 3,
    /// detached this process's pidfd as 4, and no other but standard input and error;
    /// what it prints goes to this process's standard error. What of those this process lacks is /dev/null there.
    [[nodiscard]] Status start(const std::filesystem::path& program, const std::string& argument,
                               const isolate::Channel& channel, bool detached = false);
    [[nodiscard]] bool detached() const { return detached_; }
    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Readable once the process has ended; -1 where the kernel has no such thing.
    [[nodiscard]] int endFd() const { return pidfd_.get(); }
    [[nodiscard]] const ChildWatch& watch() const { return watch_; }
    /// Any thread.
    void kill();
    /// Gives it `grace_ns` to end by itself, then kills it, and says how it ended. Takes no longer than that and
    /// ChildWatch::after_kill_ns, and asks for no memory.
    [[nodiscard]] ChildEnd reap(std::uint64_t grace_ns);

  private:
    [[nodiscard]] bool waited(ChildEnd& end);
    /// With mutex_ held.
    void sendKill() const;

    ChildWatch watch_;
    pid_t pid_ = -1;
    UniqueFd pidfd_;
    std::mutex mutex_;  ///< between kill and reap: a reaped number may be another process's
    bool running_ = false;
    bool detached_ = false;
};

}  // namespace sluice::host
