// SPDX-License-Identifier: MIT
// The table of functions behind the exported entry point.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"

namespace sluice::vk {

/// The table, or NULL if this major is not served. Lives as long as the library is loaded.
[[nodiscard]] const SluiceRendererApi* rendererApi(std::uint32_t abi_version);

}  // namespace sluice::vk
