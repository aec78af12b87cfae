// SPDX-License-Identifier: MIT
// Threads of ours in somebody else's process take none of its signals.
#pragma once

#include <pthread.h>

#include <csignal>

namespace sluice {

/// Around the start of a thread, which keeps the mask that it begins with. Signals of a thread's own making stay: they
/// tell of its faults.
class BlockedSignals {
  public:
    BlockedSignals() {
        sigset_t all;
        sigfillset(&all);
        for (const int own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT, SIGSYS}) {
            sigdelset(&all, own);
        }
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;
    ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  private:
    sigset_t before_{};
};

}  // namespace sluice
