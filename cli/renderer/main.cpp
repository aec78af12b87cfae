// SPDX-License-Identifier: MIT
// sluice-renderer: the process that an isolated renderer plugin runs in. Started by a host, never by hand.
#include <dlfcn.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string_view>

#include "sluice/abi_sizes.hpp"
#include "sluice/abi_table.hpp"
#include "sluice/isolate/server.hpp"

namespace {

int fail(std::string_view what, const char* why) {
    (void)std::fprintf(stderr, "sluice-renderer: %.*s: %s\n", static_cast<int>(what.size()), what.data(), why);
    return 1;
}

int run(const char* plugin) {
    void* library = ::dlopen(plugin, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        return fail(plugin, ::dlerror());
    }
    void* symbol = ::dlsym(library, SLUICE_RENDERER_ENTRY_SYMBOL);
    const auto entry = reinterpret_cast<SluiceRendererEntry>(symbol);
    if (entry == nullptr) {
        return fail(plugin, "does not export '" SLUICE_RENDERER_ENTRY_SYMBOL "'");
    }
    // The host has not seen the table, so it is held here to what a host in one process holds it to.
    const SluiceRendererApi* const found = entry(SLUICE_ABI_VERSION);
    if (const sluice::Status status = sluice::checkRendererTable({}, found); !status) {
        return fail(plugin, status.error().message().c_str());
    }
    const SluiceRendererApi api = sluice::readAbiStruct(*found);
    const sluice::isolate::Channel channel{sluice::UniqueFd(sluice::isolate::kChannelFd)};
    if (const sluice::Status served = sluice::isolate::serve(api, channel); !served) {
        return fail("host", served.error().message().c_str());
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const bool detached = argc == 4 && std::strcmp(argv[1], "--host") == 0;
    if (argc != 4 || (!detached && std::strcmp(argv[1], "--parent") != 0)) {
        return fail("usage", "a host starts this program, as sluice render --isolate does");
    }
    // What a terminal, timeout(1) or a service manager sends goes to the whole group of processes. The host takes it,
    // or ignores it, finishes its file and then closes the channel; this process ends with it either way.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        (void)std::signal(signal, SIG_IGN);
    }
    try {
        const bool ends = detached ? sluice::isolate::endWithWatchedHost() : sluice::isolate::endWithHost(argv[2]);
        return ends ? run(argv[3]) : 1;
    } catch (const std::exception& thrown) {
        return fail("internal fault", thrown.what());
    }
}
