// SPDX-License-Identifier: MIT
// The foam that a simulation's particles carry, summed along the view ray.
#pragma once

#include "passes/context.hpp"
#include "passes/splat.hpp"

namespace sluice::vk {

struct SplatFoamPass {
    static Result<SplatFoamPass> create(const Device& device);
    /// Behind the passes of depth, thickness and filter, whose images it reads.
    void record(const PassContext& context) const;
    SplatPipelines pipelines;
};

}  // namespace sluice::vk
