// SPDX-License-Identifier: MIT
#include "image/module/functions.hpp"

extern "C" __attribute__((visibility("default"))) const sluice::cli::images::Functions* sluice_images_entry() {
    using namespace sluice::cli::images;
    static constexpr Functions kFunctions{kBuild, writePng, writeExr, loadEnvironment, readDepthLayer};
    return &kFunctions;
}
