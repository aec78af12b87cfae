// SPDX-License-Identifier: MIT
// Spheres, or ellipsoids, drawn as points or triangles: nearest depth, and sum of thickness.
#pragma once

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

/// The same splats, drawn in one of two ways.
struct SplatPipelines {
    Pipeline points;     ///< one vertex per splat
    Pipeline triangles;  ///< one triangle per splat that is too near to be a point
};

struct SplatDepthPass {
    static Result<SplatDepthPass> create(const Device& device, bool ellipsoids);
    /// Also decides, for both splats, whether triangles are needed.
    void record(const PassContext& context) const;
    SplatPipelines pipelines;
    Pipeline near;
};

struct SplatThicknessPass {
    static Result<SplatThicknessPass> create(const Device& device, bool ellipsoids);
    void record(const PassContext& context) const;
    SplatPipelines pipelines;
    Pipeline scene;  ///< the scene's depth at the resolution of thickness
};

}  // namespace sluice::vk
