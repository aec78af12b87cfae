// SPDX-License-Identifier: MIT
// The particles of the frames to come. Frames in flight keep the set that they were recorded with.
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>

#include "device/device.hpp"
#include "frame/pass_context.hpp"
#include "memory/buffer.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// One set on the device, shared by the store and the frames that use it; the last to let go frees it.
struct ParticleSet {
    Buffer position;
    Buffer fluid;    ///< numbers of fluids; empty where none were given
    Buffer staging;  ///< empty where the host can write device-local memory itself
    Buffer fluid_staging;
    std::uint32_t count = 0;
    float radius = 0.0F;
    std::uint64_t upload_bytes = 0;
    bool recorded = false;  ///< a submitted frame has copied from staging, or nothing has to be copied

    [[nodiscard]] ParticleBuffers buffers() const {
        ParticleBuffers out{position.buffer(), count, radius};
        out.fluids = fluid ? fluid.buffer() : VK_NULL_HANDLE;
        return out;
    }
};

/// Copies the particles into a new set. The arguments have been checked, but not the device's limits.
[[nodiscard]] Result<std::shared_ptr<ParticleSet>> createParticleSet(const Device& device,
                                                                     const SluiceParticles& particles);

/// Records the copy from staging, if there is one, visible to shaders and as vertices.
void recordUpload(const Device& device, VkCommandBuffer commands, const ParticleSet& set);

}  // namespace sluice::vk
