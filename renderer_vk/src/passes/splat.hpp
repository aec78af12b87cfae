// SPDX-License-Identifier: MIT
// Spheres drawn as screen-space triangles: nearest depth, and sum of thickness.
#pragma once

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

struct SplatDepthPass {
    static Result<SplatDepthPass> create(const Device& device);
    void record(const PassContext& context) const;
    Pipeline small;  ///< one triangle per sphere
    Pipeline large;  ///< two triangles per sphere
};

struct SplatThicknessPass {
    static Result<SplatThicknessPass> create(const Device& device);
    void record(const PassContext& context) const;
    Pipeline small, large;
    Pipeline scene;  ///< the scene's depth at the resolution of thickness
};

}  // namespace sluice::vk
