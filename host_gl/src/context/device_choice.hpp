// SPDX-License-Identifier: MIT
// What SLUICE_GL_DEVICE asks for.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "sluice/result.hpp"

namespace sluice::host {

constexpr const char* kGlDeviceVariable = "SLUICE_GL_DEVICE";

/// The index of an EGL device, or nothing for the surfaceless platform.
using GlDeviceChoice = std::optional<std::size_t>;

/// "surfaceless", an index in decimal digits, or empty (the default: surfaceless). Fails naming the variable, the value
/// and what would have been right.
[[nodiscard]] Result<GlDeviceChoice> parseGlDevice(std::string_view text);
/// parseGlDevice of the environment's value. As with getenv, nobody may change the environment meanwhile.
[[nodiscard]] Result<GlDeviceChoice> glDeviceFromEnvironment();

}  // namespace sluice::host
