// SPDX-License-Identifier: MIT
// Lists of the tiles that have fluid, for everything after the splat of depth, and the clearing of what lies outside.
#pragma once

#include <cstdint>

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

/// Bytes of a list that has room for every tile of `width` x `height` texels.
[[nodiscard]] VkDeviceSize tileListBytes(std::uint32_t width, std::uint32_t height);

struct TilesPass {
    static Result<TilesPass> create(const Device& device);
    /// Also clears the images that later passes write by tiles, the shared ones among them, to "no fluid".
    void record(const PassContext& context) const;
    Pipeline pipeline;
};

}  // namespace sluice::vk
