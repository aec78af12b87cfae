// SPDX-License-Identifier: MIT
// What SLUICE_GL_DEVICE asks for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::host {

constexpr const char* kGlDeviceVariable = "SLUICE_GL_DEVICE";

/// The index of an EGL device, or nothing for the surfaceless platform.
using GlDeviceChoice = std::optional<std::size_t>;

/// "surfaceless", an index in decimal digits, or empty (the default: surfaceless). Fails naming the variable, the value
/// and what would have been right.
[[nodiscard]] Result<GlDeviceChoice> parseGlDevice(std::string_view text);
/// The variable's value; empty where it is not set. As with getenv, nobody may change the environment meanwhile.
[[nodiscard]] std::string glDeviceVariable();
/// parseGlDevice of the environment's value.
[[nodiscard]] Result<GlDeviceChoice> glDeviceFromEnvironment();

/// What to tell the user of a context whose GL_RENDERER is `renderer` and for which SLUICE_GL_DEVICE was `asked`, where
/// EGL lists a device for each element of `software`, true for software renderers. Empty where there is nothing to
/// tell: a graphics card draws, or there is none, or the software renderer was asked for.
[[nodiscard]] std::string deviceNote(std::string_view renderer, std::string_view asked,
                                     const std::vector<bool>& software);

}  // namespace sluice::host
