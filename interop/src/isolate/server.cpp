// SPDX-License-Identifier: MIT
#include "sluice/isolate/server.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <thread>

#include "isolate/call_server.hpp"
#include "sluice/blocked_signals.hpp"

namespace sluice::isolate {

bool endWithHost(std::string_view host) {
    int pid = 0;
    std::from_chars(host.data(), host.data() + host.size(), pid);
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
    return ::getppid() == pid;
}

bool endWithWatchedHost() {
    pollfd host{kHostFd, POLLIN, 0};
    if (::fcntl(kHostFd, F_SETFD, FD_CLOEXEC) != 0 || ::poll(&host, 1, 0) != 0) {
        return false;
    }
    const BlockedSignals quiet;
    std::thread([host]() mutable {
        while (::poll(&host, 1, -1) < 0 && errno == EINTR) {
        }
        (void)::kill(::getpid(), SIGKILL);
    }).detach();
    return true;
}

Status serve(const SluiceRendererApi& api, const Channel& channel) {
    return Server(api, channel).run();
}

}  // namespace sluice::isolate
