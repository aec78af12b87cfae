// SPDX-License-Identifier: MIT
// Foam that stays for a while after its water has turned white.
#pragma once

#include <volk.h>

#include <memory>

#include "live/one_set.hpp"
#include "memory/buffer.hpp"
#include "passes/pipeline.hpp"
#include "simulation/solver.hpp"

namespace sluice::vk {

/// One float for each identity that there has been. Used on the simulation's thread. Pinned; dies before `device`, when
/// no submitted work uses it.
class FoamAge {
  public:
    static Result<std::unique_ptr<FoamAge>> create(const Device& device);
    explicit FoamAge(const Device& device) : device_(device) {}
    FoamAge(const FoamAge&) = delete;
    FoamAge& operator=(const FoamAge&) = delete;
    ~FoamAge();

    /// The last of the four floats that each place of `whitewater` has becomes the greater of itself and `kept` times
    /// what it was at the call before; as it is, once there have been more identities than the device's buffers hold.
    /// Returns when the device has done it.
    [[nodiscard]] Status age(const DeviceParticles& state, VkBuffer whitewater, const PlaceBuffers& places, float kept);
    /// There has been none.
    void forget() { foam_ = {}; }

  private:
    [[nodiscard]] Status makeRoom(std::uint32_t identities);

    const Device& device_;
    Pipeline pipeline_;
    Buffer foam_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace sluice::vk
