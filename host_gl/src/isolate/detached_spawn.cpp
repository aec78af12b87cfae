// SPDX-License-Identifier: MIT
#include "isolate/detached_spawn.hpp"

#include <sched.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace sluice::host {

namespace {

constexpr std::size_t kStack = 256UL * 1024;  // posix_spawn brings one of its own for what it starts

/// In the memory of both processes.
struct Between {
    const SpawnOrder* order = nullptr;
    int failed = 0;
    pid_t pid = -1;
    int end = -1;
};

/// The process between. It shares this one's memory, which stands still meanwhile, so that it may call what posix_spawn
/// itself calls, and no more.
int startAndEnd(void* raw) {
    Between& between = *static_cast<Between*>(raw);
    const SpawnOrder& order = *between.order;
    between.failed =
        ::posix_spawn(&between.pid, order.program, order.files, order.attributes, order.arguments, environ);
    if (between.failed == 0) {
        // Here it is a child still, so that its number cannot be another's.
        between.end = static_cast<int>(::syscall(SYS_pidfd_open, between.pid, 0));
        between.failed = between.end < 0 ? errno : 0;
        if (between.end < 0) {
            (void)::kill(between.pid, SIGKILL);
        }
    }
    return 0;  // which ends this process, and runs nothing of the other one
}

}  // namespace

int spawnDetached(const SpawnOrder& order, pid_t& pid, UniqueFd& end) {
    void* const stack = ::mmap(nullptr, kStack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
    if (stack == MAP_FAILED) {
        return errno;
    }
    // A handler of this process's must not run in the one between.
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    Between between{&order};
    // No signal in the flags tells of its end, for which plain wait() is blind to it. Its descriptors are this
    // process's.
    const pid_t child =
        ::clone(startAndEnd, static_cast<char*>(stack) + kStack, CLONE_VM | CLONE_VFORK | CLONE_FILES, &between);
    const int failed = child < 0 ? errno : 0;
    while (child > 0 && ::waitpid(child, nullptr, __WALL) < 0 && errno == EINTR) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    ::munmap(stack, kStack);
    if (failed != 0 || between.failed != 0) {
        return failed != 0 ? failed : between.failed;
    }
    pid = between.pid;
    end = UniqueFd(between.end);
    return 0;
}

}  // namespace sluice::host
