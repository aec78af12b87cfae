// SPDX-License-Identifier: MIT
// A particle set as the bytes of a file. `name` is used in messages only.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ending.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::particles {

/// What the parser of the same format reads back unchanged; .pos drops velocity and colour, which it has no room for.
/// An error if a value is not finite, the arrays' sizes disagree, or .pos has no radius to write.
[[nodiscard]] Result<std::vector<std::byte>> encode(const ParticleSet& set, Format format, const std::string& name);

}  // namespace sluice::particles
