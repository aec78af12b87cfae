// SPDX-License-Identifier: MIT
// The renderer's process: a renderer's table of functions, called over a channel.
#pragma once

#include <string_view>

#include "sluice/isolate/channel.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::isolate {

/// Where the host puts a started process's end of the channel.
inline constexpr int kChannelFd = 3;
/// And where a detached one's is given the host's pidfd.
inline constexpr int kHostFd = 4;
/// This process ends when the host does, even inside a driver that hangs. `host`: its number, as it was given on the
/// command line. False: the host has ended already.
[[nodiscard]] bool endWithHost(std::string_view host);
/// The same for one that is no child of the host: a thread watches kHostFd.
[[nodiscard]] bool endWithWatchedHost();

/// Serves `api` until the host closes the channel; a renderer that is left then is destroyed. An error is the host's
/// breach of the protocol. Calls of the renderer come on this thread; two threads more carry the counters.
[[nodiscard]] Status serve(const SluiceRendererApi& api, const Channel& channel);

}  // namespace sluice::isolate
