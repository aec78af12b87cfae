// SPDX-License-Identifier: MIT
// UUIDs of devices and drivers as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "sluice/plugin.h"

namespace sluice {

/// All 16 bytes, with the hyphens of RFC 4122: "6d657361-3232-2e33-2e36-000000000000".
[[nodiscard]] std::string uuidText(std::span<const std::uint8_t, SLUICE_UUID_SIZE> uuid);

}  // namespace sluice
