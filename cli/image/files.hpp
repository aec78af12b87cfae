// SPDX-License-Identifier: MIT
// Whether image files can be read and written: libsluice_images.so, beside the program or in ../lib/sluice.
#pragma once

#include "sluice/result.hpp"

namespace sluice::cli {

/// Loads the module, once for the process, which keeps it. The error names every place that was looked at, and what the
/// loader said. Any thread. writePng, writeExr, loadEnvironment and readDepthLayer ask it themselves; who renders
/// for an hour first asks before.
[[nodiscard]] Status imageFilesPossible();

}  // namespace sluice::cli
