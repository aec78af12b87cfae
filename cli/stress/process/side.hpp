// SPDX-License-Identifier: MIT
// The Vulkan side in a process of its own.
#pragma once

#include <memory>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "stress/vk/side.hpp"

namespace sluice::stress {

/// Starts the process, which opens the device of `host`. Whoever lets go of it has ended and reaped it. If it ends
/// before, every wait ends and lost() says how.
[[nodiscard]] Result<std::unique_ptr<VkSide>> startVkProcess(const SluiceHostCapabilities& host);

}  // namespace sluice::stress
