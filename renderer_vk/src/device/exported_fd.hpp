// SPDX-License-Identifier: MIT
// Descriptors that the driver exports.
#pragma once

#include <volk.h>

#include <string_view>

#include "sluice/fd.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// What `call` made of an opaque fd: owned, or why there is none. A negative one is a failure whatever the result says:
/// -1 means something (already signalled) for sync files only.
[[nodiscard]] Result<UniqueFd> exportedFd(VkResult result, int fd, std::string_view call);

}  // namespace sluice::vk
