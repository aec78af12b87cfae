// SPDX-License-Identifier: MIT
// What both sides call what they share: groups of image roles as masks of SLUICE_ROLE_BIT, and a name.
#pragma once

#include <cstdint>
#include <string_view>

#include "sluice/plugin.h"

namespace sluice {

/// The renderer writes these only for a host that lists them as outputs.
inline constexpr std::uint32_t kOptionalFluidRoles =
    SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);
/// The renderer writes these in every frame, listed or not.
inline constexpr std::uint32_t kAlwaysMadeFluidRoles =
    SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_COLOUR) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_DEPTH);
/// All that the renderer writes; the only bits that `outputs` may have.
inline constexpr std::uint32_t kFluidRoles = kAlwaysMadeFluidRoles | kOptionalFluidRoles;
/// Without these there is no frame.
inline constexpr std::uint32_t kAlwaysSharedRoles =
    SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_COLOUR) | SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_DEPTH) | kAlwaysMadeFluidRoles;

/// In traces. The buffers that depths are captured into for a simulation are acquired and released under this name, a
/// space and their number from 0: the queue acquires with the value of the release before it (0: there was none) and
/// releases with that of its frame; the simulation acquires with that, and releases with a number of its own, 1,
/// 2, 3...
inline constexpr std::string_view kCapturedDepth = "CAPTURED_DEPTH";

}  // namespace sluice
