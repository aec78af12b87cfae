// SPDX-License-Identifier: MIT
// What a caller may pass. Each check names the field, its value and what is allowed.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// For describe, which takes only the UUIDs from info: services, versions and sizes of structs.
[[nodiscard]] Status checkServices(const SluiceHostServices* host);
[[nodiscard]] Status checkCreateHeader(const SluiceCreateInfo* info);
/// For create: all of info, and services that share images.
[[nodiscard]] Status checkCreateInfo(const SluiceHostServices* host, const SluiceCreateInfo* info);
/// Both levels of it, each with what its struct_size does not cover as zero. It has passed checkCreateHeader.
[[nodiscard]] SluiceCreateInfo readCreateInfo(const SluiceCreateInfo& info);
[[nodiscard]] Status checkSize(std::uint32_t width, std::uint32_t height);
[[nodiscard]] Status checkParticles(const SluiceParticles* particles);
[[nodiscard]] Status checkEnvironment(const SluiceEnvironment* environment);
[[nodiscard]] Status checkNeeds(const SluiceSceneNeeds* needs);

/// What the renderer knows when a frame comes.
struct FrameExpectation {
    std::uint64_t submitted = 0;  ///< last frame that was submitted
    std::uint64_t attempted = 0;  ///< last frame that came in order, whether or not it then failed
    std::uint32_t image_sets = 1;
    std::uint32_t outputs = 0;  ///< FLUID_* roles that are shared
};
/// The frame's place in the protocol: number, values, image set. The fluid is the plan's to check.
[[nodiscard]] Status checkFrameOrder(const SluiceFrame& frame, const FrameExpectation& expected);
/// Its camera, sky, flags and outputs.
[[nodiscard]] Status checkFrameValues(const SluiceFrame& frame, const FrameExpectation& expected);

}  // namespace sluice::vk
