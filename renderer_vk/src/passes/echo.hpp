// SPDX-License-Identifier: MIT
// The passes without fluid: the host's images echoed, or "no fluid" where there are no particles.
#pragma once

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

struct EchoPass {
    static Result<EchoPass> create(const Device& device);
    void record(const PassContext& context) const;
    Pipeline pipeline;
};

struct ClearPass {
    static Result<ClearPass> create(const Device& device);
    void record(const PassContext& context) const;
    Pipeline pipeline;
};

}  // namespace sluice::vk
