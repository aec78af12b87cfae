// SPDX-License-Identifier: MIT
// Ctrl-C as a question that the frame loop asks between files, and the solver between steps.
#pragma once

namespace sluice::cli {

/// From now on the first SIGINT or SIGTERM only sets a flag; a second one ends the program at once.
void watchForInterrupt();
[[nodiscard]] bool interrupted();

}  // namespace sluice::cli
