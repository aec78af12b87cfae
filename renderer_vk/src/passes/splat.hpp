// SPDX-License-Identifier: MIT
// Spheres drawn as points or triangles: nearest depth, and sum of thickness.
#pragma once

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

/// The same spheres, drawn in one of two ways.
struct SplatPipelines {
    Pipeline points;     ///< one vertex per sphere
    Pipeline triangles;  ///< one triangle per sphere that is too near to be a point
};

struct SplatDepthPass {
    static Result<SplatDepthPass> create(const Device& device);
    /// Also decides, for both splats, whether triangles are needed.
    void record(const PassContext& context) const;
    SplatPipelines pipelines;
    Pipeline near;
};

struct SplatThicknessPass {
    static Result<SplatThicknessPass> create(const Device& device);
    void record(const PassContext& context) const;
    SplatPipelines pipelines;
    Pipeline scene;  ///< the scene's depth at the resolution of thickness
};

}  // namespace sluice::vk
