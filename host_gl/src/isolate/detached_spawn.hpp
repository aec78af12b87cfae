// SPDX-License-Identifier: MIT
// A process that this one has started and that is no child of its.
#pragma once

#include <spawn.h>
#include <sys/types.h>

#include "sluice/fd.hpp"

namespace sluice::host {

/// What posix_spawn takes.
struct SpawnOrder {
    const char* program = nullptr;
    const posix_spawn_file_actions_t* files = nullptr;
    const posix_spawnattr_t* attributes = nullptr;
    char* const* arguments = nullptr;
};

/// It is a grandchild, whose parent has ended: no wait() of this process finds it, and no SIGCHLD comes of it, nor of
/// the one between. Its end is seen by `end`, how it ended by nobody. 0, or an error's number.
[[nodiscard]] int spawnDetached(const SpawnOrder& order, pid_t& pid, UniqueFd& end);

}  // namespace sluice::host
