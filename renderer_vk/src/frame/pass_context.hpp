// SPDX-License-Identifier: MIT
// What passes of a frame see of the frame: the boundary between frame/ (who submits) and passes/ (who records).
#pragma once

#include <volk.h>

#include <cstdint>

#include "sluice/plugin.h"

namespace sluice::vk {

/// An image as a pass uses it. Not owned. A null view means that the frame has no such image.
struct ImageRef {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t width = 0, height = 0;
};

/// The shared images of one set, acquired and in VK_IMAGE_LAYOUT_GENERAL. Passes leave them in GENERAL.
struct FrameTargets {
    ImageRef host_colour, host_depth, fluid_colour, fluid_depth, fluid_normal, fluid_thickness;
    SluiceDepthEncoding host_depth_encoding = SLUICE_DEPTH_WINDOW;
};

/// Particles on the device: tightly packed float triples, world metres.
struct ParticleBuffers {
    VkBuffer position = VK_NULL_HANDLE;
    std::uint32_t count = 0;  ///< at most, if `draw` says how many
    float radius = 0.0F;
    VkBuffer draw = VK_NULL_HANDLE;        ///< may be none; a VkDrawIndirectCommand of a vertex for each particle
    VkBuffer ellipsoids = VK_NULL_HANDLE;  ///< kEllipsoidFloats each, of plans with ellipsoids
    float longest = 1.0F;                  ///< of their axes, in splat radii
    VkBuffer whitewater = VK_NULL_HANDLE;  ///< kWhitewaterFloats each, of plans with foam
    VkBuffer fluids = VK_NULL_HANDLE;      ///< a number each, of plans with several looks
};

/// What the depth buffer of the frame's camera is captured into; `into` empty: it is not.
struct DepthCapture {
    VkBuffer into = VK_NULL_HANDLE;
    std::uint32_t scale = 1;  ///< pixels each way that become one
    float thickness = 0.0F;   ///< m
};

/// What a pass tells of itself when it starts.
struct PassLabel {
    const char* name = "";       ///< at most 31 characters; string literal
    std::uint64_t elements = 0;  ///< particles or pixels
    std::uint64_t bytes = 0;     ///< compulsory traffic
    bool elements_are_particles = false;
    std::uint32_t dispatches = 1;  ///< draws or dispatches it records
};

/// Timestamps and statistics around each pass; frame/ implements it.
class PassTimer {
  public:
    virtual ~PassTimer() = default;
    virtual void begin(VkCommandBuffer commands, const PassLabel& label) = 0;
    virtual void end(VkCommandBuffer commands) = 0;
};

}  // namespace sluice::vk
