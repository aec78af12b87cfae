// SPDX-License-Identifier: MIT
// What is derived from depth and thickness before shading: normals, and thickness without the grain of particles.
#pragma once

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

struct NormalsPass {
    static Result<NormalsPass> create(const Device& device);
    void record(const PassContext& context) const;
    Pipeline pipeline;
};

struct BlurThicknessPass {
    /// `several_looks`: their optical depth, too.
    static Result<BlurThicknessPass> create(const Device& device, bool several_looks);
    void record(const PassContext& context) const;
    Pipeline along_x, along_y;
    bool several_looks;
};

}  // namespace sluice::vk
