// SPDX-License-Identifier: MIT
// The solver's memory. Everything is sized by a capacity that grows and never shrinks.
#pragma once

#include <volk.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "memory/buffer.hpp"
#include "simulation/parameters.hpp"

namespace sluice::vk {

/// A buffer as the passes name it. In and Out change places after each step that is kept.
enum class Slot : std::uint8_t {
    Parameters,
    PositionIn,
    VelocityIn,
    IdentityIn,
    PositionOut,
    VelocityOut,
    IdentityOut,
    Predicted,
    Arrival,
    Cells,
    Sums,
    Bucket,
    Sorted,
    Before,
    Pushed,
    Walls,
    List,
    ListCount,
    Moving,
    Curl,
    Sources,
    Births,
    Blocked,
    Bodies,
    Pushes,
    Status,
    Count,
    Meshes,  ///< none of these: the solver makes it once
    Seen     ///< nor of these: whoever gives the depth field makes it
};
inline constexpr std::size_t kSlots = static_cast<std::size_t>(Slot::Count);

/// A view of a buffer as texels. What neighbours are read through: on llvmpipe (Mesa 22.3) the same pass over storage
/// buffers took half as much CPU time again.
class TexelView {
  public:
    TexelView() = default;
    TexelView(TexelView&& other) noexcept;
    TexelView& operator=(TexelView&& other) noexcept;
    TexelView(const TexelView&) = delete;
    TexelView& operator=(const TexelView&) = delete;
    ~TexelView();
    static Result<TexelView> create(const Device& device, const Buffer& buffer, VkFormat format, const char* name);

    VkBufferView handle = VK_NULL_HANDLE;

  private:
    const Device* device_ = nullptr;
};

/// What the status buffer holds after a step.
struct StepStatus {
    std::uint32_t faults, most_neighbours, speed_bits, move_bits, gone, stillborn, fullest;
};

inline constexpr VkDeviceSize kPushBytes = sizeof(BodyPush) * kMaxBodies;

struct SimulationBuffers {
    std::array<Buffer, kSlots> slots;
    std::array<TexelView, kSlots> texels;  ///< of those that are read as texels
    Buffer read_back;                      ///< StepStatus and the pushes of bodies, for the host
    std::uint32_t particles = 0;           ///< capacity
    std::uint32_t neighbours = 0;          ///< rows of the lists
    std::uint32_t cells = 0;
    std::uint32_t births = 0;  ///< of one step

    [[nodiscard]] const Buffer& operator[](Slot slot) const { return slots[static_cast<std::size_t>(slot)]; }
    /// Distance between rows of the lists: a whole number of workgroups.
    [[nodiscard]] std::uint32_t stride() const { return (particles + 63) / 64 * 64; }
};

/// New buffers for so many particles, neighbours of each, and cells. OUT_OF_MEMORY or UNSUPPORTED if the device cannot.
[[nodiscard]] Result<SimulationBuffers> createBuffers(const Device& device, std::uint32_t particles,
                                                      std::uint32_t neighbours, std::uint32_t cells);
/// Longer lists, which lose what they held; everything else stays.
[[nodiscard]] Status growLists(const Device& device, SimulationBuffers& buffers, std::uint32_t neighbours);
/// Room for more births of one step; everything else stays.
[[nodiscard]] Status growBirths(const Device& device, SimulationBuffers& buffers, std::uint32_t births);

}  // namespace sluice::vk
