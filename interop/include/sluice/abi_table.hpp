// SPDX-License-Identifier: MIT
// What a renderer's table of functions must be before anybody calls one of them.
#pragma once

#include <string>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// `api` is what the entry of `thing` has returned, NULL included: of this ABI major, no shorter than in ABI 1.0, and
/// no function of ABI 1.0 is NULL. Read it with readAbiStruct afterwards. The error names `thing` and what was found.
[[nodiscard]] Status checkRendererTable(const std::string& thing, const SluiceRendererApi* api);

}  // namespace sluice
