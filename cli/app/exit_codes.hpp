// SPDX-License-Identifier: MIT
// What the program's exit status means; docs/cli.md and --help say the same.
#pragma once

namespace sluice::cli {

enum ExitCode : int {
    kExitOk = 0,
    kExitUsage = 1,         ///< the command line is wrong
    kExitFindings = 1,      ///< diagnose alone: the log was read, and something is wrong with its order
    kExitBadInput = 2,      ///< an input file is missing or wrong: nothing was written for it
    kExitNoFluid = 3,       ///< the renderer is missing or failed: the host's own frames were still written; or
                            ///< the validation layer had something to say
    kExitInternal = 4,      ///< no OpenGL, no memory, an output that cannot be written, or a fault of ours
    kExitInterrupted = 130  ///< Ctrl-C: the file in hand was finished
};

}  // namespace sluice::cli
