// SPDX-License-Identifier: MIT
// The renderer's process: a renderer's table of functions, called over a channel.
#pragma once

#include "sluice/isolate/channel.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::isolate {

/// Serves `api` until the host closes the channel; a renderer that is left then is destroyed. An error is the host's
/// breach of the protocol. Calls of the renderer come on this thread; two threads more carry the counters.
[[nodiscard]] Status serve(const SluiceRendererApi& api, const Channel& channel);

}  // namespace sluice::isolate
