// SPDX-License-Identifier: MIT
// The other process of `sluice stress --topology two-processes`.
#pragma once

#include "sluice/isolate/channel.hpp"
#include "sluice/result.hpp"

namespace sluice::stress {

/// Serves a Vulkan side of this process until the host closes the channel. An error is the host's breach of the
/// protocol.
[[nodiscard]] Status serveVulkan(const isolate::Channel& channel);

}  // namespace sluice::stress
