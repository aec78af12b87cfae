// SPDX-License-Identifier: MIT
// Pure checks of what a caller asks for and of what a renderer says that it did.
#pragma once

#include <cstdint>

#include "share/image_table.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

[[nodiscard]] Status checkExtent(std::uint32_t width, std::uint32_t height);
[[nodiscard]] Status checkConfig(const FluidHostConfig& config);
/// What can be known of a part of the scene without a renderer; what passes may be read as far as it says.
[[nodiscard]] Status checkPart(const SluiceParticles& particles);
[[nodiscard]] Status checkPart(const SluiceEnvironment* environment);
[[nodiscard]] Status checkPart(const SluiceSimulation* simulation);
[[nodiscard]] Status checkPart(const SluiceStart* start);
/// The renderer's account must agree with what was asked for and with the images that it shared.
[[nodiscard]] Status checkInfo(const SluiceRendererInfo& info, const FluidHostConfig& config, const ImageTable& images);

}  // namespace sluice::host
