// SPDX-License-Identifier: MIT
// One descriptor set of storage buffers, for a pass whose last use has always ended before the next.
#pragma once

#include <volk.h>

#include <cstddef>
#include <span>

#include "device/device.hpp"
#include "passes/pipeline.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// `pool` is the caller's to destroy, on failure, too.
[[nodiscard]] Status makeOneSet(const Device& device, const Pipeline& pipeline, std::size_t bindings,
                                VkDescriptorPool& pool, VkDescriptorSet& set);
/// Binds the buffers, whole, from binding 0 on. No submitted work may use the set.
void writeOneSet(const Device& device, VkDescriptorSet set, std::span<const VkBuffer> buffers);

}  // namespace sluice::vk
