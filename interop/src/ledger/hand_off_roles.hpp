// SPDX-License-Identifier: MIT
// What both halves of the feed know of the shared images.
#pragma once

#include "sluice/ledger/hand_off_feed.hpp"
#include "sluice/roles.hpp"

namespace sluice::ledger {

inline constexpr std::uint32_t kGBufferRoles =
    SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_COLOUR) | SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_DEPTH);
inline constexpr std::uint64_t kGeneral = 1;  // VK_IMAGE_LAYOUT_GENERAL
inline constexpr std::uint64_t kGeneralToGeneral = kGeneral << 32U | kGeneral;

}  // namespace sluice::ledger
