// SPDX-License-Identifier: MIT
// What a pass sees while it records, and the barriers between passes.
#pragma once

#include <array>
#include <cstdint>

#include "frame/pass_context.hpp"
#include "memory/buffer.hpp"
#include "memory/image.hpp"
#include "passes/arena.hpp"
#include "plan/plan.hpp"

namespace sluice::vk {

/// Side of a tile, texels: TILE of tiles.glsl and the workgroup of every pass over tiles.
inline constexpr std::uint32_t kTileTexels = 16;

/// The renderer's own images, one copy: frames of one queue take turns. Those that the plan leaves out are empty.
struct PassImages {
    std::array<Image, static_cast<std::size_t>(PlanImage::Count)> own;
    Image nothing_to_read;   ///< 1x1, stands in where a shader's input is switched off
    Image nothing_to_write;  ///< 1x1, stands in where a shader's output is switched off
    Buffer near_draw;        ///< indirect draws: of the spheres that are too near to be points, and of the points
    Buffer surface_tiles;    ///< which tiles have fluid; see shaders/common/tiles.glsl
    Buffer thickness_tiles;  ///< the same at the resolution of thickness, with the margin of its blur

    [[nodiscard]] const Image& operator[](PlanImage id) const { return own[static_cast<std::size_t>(id)]; }
    [[nodiscard]] VkImageView readable(PlanImage id) const {
        const Image& image = (*this)[id];
        return image ? image.view() : nothing_to_read.view();
    }
};

struct PassContext {
    const Device& device;
    VkCommandBuffer commands;
    const SluiceFrame& frame;
    const Plan& plan;
    const FrameTargets& targets;
    const ParticleBuffers& particles;
    PassTimer& timer;
    FrameArena& arena;
    const PassImages& images;

    [[nodiscard]] std::uint64_t pixels() const { return std::uint64_t{plan.width} * plan.height; }
};

/// Splats draw into it.
[[nodiscard]] constexpr bool isDrawn(PlanImage id) {
    return id == PlanImage::DepthA || id == PlanImage::Thickness || id == PlanImage::OpticalDepth ||
           id == PlanImage::Foam;
}
/// Before the first pass: the last frame's use of the renderer's images is over, their contents are dropped, those that
/// are drawn into are colour attachments and the others are in GENERAL.
void openImages(const PassContext& context);
/// After a splat: its image goes from attachment to GENERAL, readable by compute.
void closeAttachment(const PassContext& context, PlanImage id);
/// Between dispatches: what was written is readable and may be overwritten.
void betweenDispatches(const PassContext& context);
/// After a dispatch: what it wrote is readable by fragments.
void beforeFragments(const PassContext& context);
/// What `from` wrote (`written`) may be used by `to` as `used`.
void order(const PassContext& context, VkPipelineStageFlags2 from, VkAccessFlags2 written, VkPipelineStageFlags2 to,
           VkAccessFlags2 used);
/// A workgroup for each tile of the list.
void dispatchTiles(const PassContext& context, const Buffer& tiles);
/// Enough workgroups of `tile_x` x `tile_y` to cover `width` x `height`.
void dispatchOver(const PassContext& context, std::uint32_t width, std::uint32_t height, std::uint32_t tile_x,
                  std::uint32_t tile_y);

}  // namespace sluice::vk
