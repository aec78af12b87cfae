// SPDX-License-Identifier: MIT
// Names for the words of SluiceRendererCapabilities::reserved that have a meaning; zero says nothing in each.
#pragma once

#include <cstddef>

namespace sluice {

/// The most particles that set_particles takes.
inline constexpr std::size_t kMaxParticlesWord = 0;

}  // namespace sluice
