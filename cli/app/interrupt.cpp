// SPDX-License-Identifier: MIT
#include "app/interrupt.hpp"

#include <csignal>

namespace sluice::cli {
namespace {

// The one thing that a signal handler may touch, hence not a member of anything.
volatile std::sig_atomic_t interrupt_seen = 0;

void note(int /*signal*/) {
    interrupt_seen = 1;
}

}  // namespace

void watchForInterrupt() {
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigemptyset(&action.sa_mask);
    (void)sigaction(SIGINT, &action, nullptr);
    (void)sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
    return interrupt_seen != 0;
}

}  // namespace sluice::cli
