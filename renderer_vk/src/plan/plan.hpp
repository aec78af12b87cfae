// SPDX-License-Identifier: MIT
// The pass plan: what a scene needs becomes an ordered list of passes, the images between them, and the reasons.
// Pure: no Vulkan type, no state, the same answer for the same needs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Every pass that there is, in the order in which a frame runs them.
enum class PassId : std::uint8_t {
    SplatDepth,
    Tiles,  ///< lists the tiles with fluid, and clears what the passes over tiles leave out
    Filter,
    Normals,
    SplatThickness,
    BlurThickness,
    SplatFoam,  ///< of a simulation that makes some
    Shade,
    Echo,
    Clear,  ///< no particles: the fluid images say "no fluid"
    Count
};

/// Every image that a pass may read or write. Those from HostColour on are shared, uploaded or buffers, and
/// none of these is allocated by the plan.
enum class PlanImage : std::uint8_t {
    DepthA,         ///< R32F metres along -z; 1e30 = empty
    DepthB,         ///< the other half of the filter's ping-pong
    Normal,         ///< RGBA16F eye-space unit normal, w = 1 on fluid
    Thickness,      ///< R32F metres along the view ray, reduced resolution
    ThicknessSums,  ///< RG32F weighted sum and weight between the two directions of the blur
    OpticalDepth,   ///< RGBA32F sum of absorption times metres, of several looks; a unused
    OpticalSums,    ///< RGBA32F its weighted sum between the two directions of the blur
    SceneDepth,     ///< R32F farthest scene depth in each texel of Thickness, metres; 1e30 = nothing
    Foam,           ///< R32F metres of foam along the view ray, at the resolution of Thickness
    HostColour,
    HostDepth,
    Environment,
    SurfaceTiles,    ///< a buffer: the list of tiles with fluid
    ThicknessTiles,  ///< a buffer: the same for thickness, with the margin of its blur
    FluidColour,
    FluidDepth,
    FluidNormal,
    FluidThickness,
    Count
};

/// One pass of the frame.
struct PlannedPass {
    PassId id = PassId::Count;
    std::vector<PlanImage> reads, writes;  ///< each image once; one in both is rewritten in place by stages of the pass
    std::uint32_t dispatches = 1;          ///< draws or dispatches that it records
    std::string reason;

    bool operator==(const PlannedPass&) const = default;
};

/// One image that the renderer allocates for itself, one copy for all image sets.
struct PlannedImage {
    PlanImage id = PlanImage::Count;
    SluiceFormat format = SLUICE_FORMAT_NONE;
    std::uint32_t width = 0, height = 0;

    bool operator==(const PlannedImage&) const = default;
};

/// One pass that the scene does not need.
struct OmittedPass {
    PassId id = PassId::Count;
    std::string reason;

    bool operator==(const OmittedPass&) const = default;
};

/// The answer. Equal plans need no new resources and no new pipelines; numbers that only change pixels are in
/// SluiceFrame.
struct Plan {
    std::uint32_t width = 0, height = 0;
    SluiceView view = SLUICE_VIEW_FLUID;
    std::uint32_t filter_iterations = 0;
    bool ellipsoids = false;  ///< splats are what their neighbours make of them, not spheres
    bool several_looks = false;
    bool refraction = false;
    bool reflection = false;
    bool environment_map = false;
    std::uint32_t outputs = 0;              ///< roles that shade writes besides colour and depth
    PlanImage surface = PlanImage::DepthA;  ///< where the final depth is
    std::vector<PlannedPass> passes;
    std::vector<PlannedImage> images;
    std::vector<OmittedPass> omitted;

    bool operator==(const Plan&) const = default;
};

/// Most pixels that a filter's half-width may reach: bounds its loop iterations.
inline constexpr std::uint32_t kMaxFilterPixels = 128;
/// Most filter iterations.
inline constexpr std::uint32_t kMaxFilterIterations = 16;

/// Fails if a number of `needs` is out of range (size 1..16384, radii and indices finite and positive, kinds known);
/// the error names the field, its value and the range.
[[nodiscard]] Result<Plan> makePlan(const SluiceSceneNeeds& needs);

/// One line per pass in order, kept or left out, with the reason, what it reads and writes; then one line per image
/// with format, size and bytes.
[[nodiscard]] std::vector<std::string> explain(const Plan& plan);

[[nodiscard]] std::string_view toString(PassId pass);
[[nodiscard]] std::string_view toString(PlanImage image);

/// The pass of this kind, or nullptr if the plan leaves it out.
[[nodiscard]] const PlannedPass* findPass(const Plan& plan, PassId pass);
/// The image of this kind, or nullptr if the plan does not allocate it.
[[nodiscard]] const PlannedImage* findImage(const Plan& plan, PlanImage image);

}  // namespace sluice::vk
