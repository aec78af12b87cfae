// SPDX-License-Identifier: MIT
#pragma once

#include "sluice/host_gl/engine.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// Every size of the scene can be built. INVALID_ARGUMENT otherwise, naming the object and its numbers.
[[nodiscard]] Status checkScene(const EngineScene& scene);

}  // namespace sluice::host
