// SPDX-License-Identifier: MIT
// Spheres, or ellipsoids, drawn as points or triangles: nearest depth, and sum of thickness.
#pragma once

#include <span>

#include "passes/context.hpp"
#include "passes/pipeline.hpp"

namespace sluice::vk {

/// The same splats, drawn in one of two ways.
struct SplatPipelines {
    Pipeline points;     ///< one vertex per splat
    Pipeline triangles;  ///< one triangle per splat that is too near to be a point
};

/// `scaled`: the target has the resolution of thickness.
[[nodiscard]] Result<SplatPipelines> splatPipelines(const Device& device, SplatDesc desc, bool scaled);

struct SplatTarget {
    PlanImage id;
    float clear;
};
/// Splats into cleared attachments of one size, as SplatDepthPass has found out how to draw them.
void drawSplats(const PassContext& context, std::span<const SplatTarget> targets, const SplatPipelines& pipelines,
                std::span<const Binding> bindings);

struct SplatDepthPass {
    static Result<SplatDepthPass> create(const Device& device, bool ellipsoids);
    /// Also decides, for both splats, whether triangles are needed.
    void record(const PassContext& context) const;
    SplatPipelines pipelines;
    Pipeline near;
};

struct SplatThicknessPass {
    /// `several_looks`: with the optical depth of each splat's own fluid beside its metres.
    static Result<SplatThicknessPass> create(const Device& device, bool ellipsoids, bool several_looks);
    void record(const PassContext& context) const;
    SplatPipelines pipelines;
    Pipeline scene;  ///< the scene's depth at the resolution of thickness
    bool several_looks;
};

}  // namespace sluice::vk
