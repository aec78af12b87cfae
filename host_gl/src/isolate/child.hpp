// SPDX-License-Identifier: MIT
// One process that this one has started.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>

#include "sluice/fd.hpp"
#include "sluice/isolate/channel.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// Owns a child process: whoever lets go of it has killed and reaped it.
class Child {
  public:
    Child() = default;
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();

    /// Starts `program --parent PID argument` with `channel` as descriptor 3 and no other but standard input and error;
    /// what it prints goes to this process's standard error.
    [[nodiscard]] Status start(const std::filesystem::path& program, const std::string& argument,
                               const isolate::Channel& channel);
    [[nodiscard]] pid_t pid() const { return pid_; }
    /// Readable once the process has ended; -1 where the kernel has no such thing.
    [[nodiscard]] int endFd() const { return pidfd_.get(); }
    /// Any thread.
    void kill();
    /// Gives it `grace_ns` to end by itself, then kills it, and says how it ended: "was killed by signal 9 (SIGKILL)".
    /// `clean`: it ended with exit code 0.
    [[nodiscard]] std::string reap(std::uint64_t grace_ns, bool& clean);

  private:
    pid_t pid_ = -1;
    UniqueFd pidfd_;
    std::mutex mutex_;  ///< between kill and reap: a reaped number may be another process's
    bool running_ = false;
};

}  // namespace sluice::host
