// SPDX-License-Identifier: MIT
// The groups of image roles that both sides reason about, as masks of SLUICE_ROLE_BIT.
#pragma once

#include <cstdint>

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

}  // namespace sluice
