// SPDX-License-Identifier: MIT
#include "app/commands.hpp"

int main(int argc, char** argv) {
    return sluice::cli::runCommandLine(argc, argv);
}
