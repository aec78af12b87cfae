// SPDX-License-Identifier: MIT
// sluice-stress-vulkan: the Vulkan side of `sluice stress --topology two-processes`. Started by it, never by hand.
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include "sluice/isolate/server.hpp"
#include "stress/process/worker.hpp"

namespace {

int fail(const char* why) {
    (void)std::fprintf(stderr, "sluice-stress-vulkan: %s\n", why);
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4 || std::strcmp(argv[1], "--parent") != 0) {
        return fail("sluice stress starts this program");
    }
    // Ctrl-C goes to the whole group of processes. The host takes it, finishes its check and then closes the channel.
    (void)std::signal(SIGINT, SIG_IGN);
    try {
        if (!sluice::isolate::endWithHost(argv[2])) {
            return 1;
        }
        const sluice::isolate::Channel channel{sluice::UniqueFd(sluice::isolate::kChannelFd)};
        const sluice::Status served = sluice::stress::serveVulkan(channel);
        return served ? 0 : fail(served.error().message().c_str());
    } catch (const std::exception& thrown) {
        return fail(thrown.what());
    }
}
