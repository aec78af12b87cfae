// SPDX-License-Identifier: MIT
// The passes of a step as pipelines, with the buffers that each one reads and writes.
#pragma once

#include <volk.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "passes/pipeline.hpp"
#include "simulation/buffers.hpp"
#include "simulation/density_kernel.hpp"

namespace sluice::vk {

enum class Kernel : std::uint8_t {
    Predict,
    ScanSums,
    ScanBlocks,
    ScanCells,
    Depth,
    Scatter,
    Order,
    Neighbours,
    Lambda,
    Measure,
    Delta,
    Velocity,
    Curl,
    Surface,
    Finish,
    Retire,
    Born,
    Count
};
inline constexpr std::size_t kKernels = static_cast<std::size_t>(Kernel::Count);

/// Cells that one invocation of the scan walks over.
inline constexpr std::uint32_t kScanBlock = 512;

/// What a scene needs beyond the plain step. A pass without it is compiled without it.
struct Features {
    bool confined = false;         ///< vorticity confinement
    bool fields = false;           ///< force fields
    bool bodies = false;           ///< bodies that are pushed
    bool tension = false;          ///< surface tension or adhesion
    bool meshes = false;           ///< solids of triangles
    bool seen = false;             ///< a depth field
    bool fluids = false;           ///< several, each with its own density
    std::uint32_t depth_axis = 1;  ///< along which depth is measured, where it is
    DensityKernel density = DensityKernel::Poly6;
    bool operator==(const Features&) const = default;
};

[[nodiscard]] const char* kernelName(Kernel kernel);

/// Pipelines and descriptor sets. The sets name the buffers that they were bound to; bind again when one is replaced.
class Kernels {
  public:
    static Result<Kernels> create(const Device& device, const Features& features);
    Kernels() = default;
    Kernels(Kernels&& other) noexcept;
    Kernels& operator=(Kernels&& other) noexcept;
    Kernels(const Kernels&) = delete;
    Kernels& operator=(const Kernels&) = delete;
    ~Kernels();

    /// Points every set at `buffers`, the grid of the meshes and the depth field. No submitted work may use the sets.
    void bind(const SimulationBuffers& buffers, const Buffer& meshes, VkBuffer seen) const;
    /// One dispatch of so many workgroups. `odd`: In and Out have changed places.
    void dispatch(VkCommandBuffer commands, Kernel kernel, bool odd, std::uint32_t groups) const;

  private:
    const Device* device_ = nullptr;
    Features features_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::array<Pipeline, kKernels> pipelines_;
    std::array<std::array<VkDescriptorSet, 2>, kKernels> sets_{};
};

}  // namespace sluice::vk
