// SPDX-License-Identifier: MIT
// The narrow-range filter: x and y per iteration between DepthA and DepthB, then the 2-D clean-up into DepthB.
#pragma once

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

struct FilterPass {
    static Result<FilterPass> create(const Device& device);
    void record(const PassContext& context) const;
    Pipeline along_x, along_y, clean;
};

}  // namespace sluice::vk
