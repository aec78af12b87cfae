// SPDX-License-Identifier: MIT
// Where each particle lies in an output slot when particles come and go: shaders/places.comp and its buffers.
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>

#include "memory/buffer.hpp"
#include "passes/pipeline.hpp"
#include "simulation/solver.hpp"

namespace sluice::vk {

/// Of one thread; its work must have ended when it is used again. Pinned; dies before `device`.
class ParticlePlaces {
  public:
    static Result<std::unique_ptr<ParticlePlaces>> create(const Device& device);
    explicit ParticlePlaces(const Device& device) : device_(device) {}
    ParticlePlaces(const ParticlePlaces&) = delete;
    ParticlePlaces& operator=(const ParticlePlaces&) = delete;
    ~ParticlePlaces();

    /// Room for every identity of `state`.
    [[nodiscard]] Status prepare(const DeviceParticles& state);
    /// Counts. What it leaves is readable by compute shaders.
    void record(VkCommandBuffer commands, const DeviceParticles& state) const;
    [[nodiscard]] VkBuffer marks() const { return marks_.buffer(); }
    [[nodiscard]] VkBuffer before() const { return before_.buffer(); }

  private:
    const Device& device_;
    Buffer marks_, before_, sums_;
    Pipeline pipeline_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace sluice::vk
