// SPDX-License-Identifier: MIT
// From what was read back to the channels of the layered EXR.
#pragma once

#include <optional>

#include "image/exr.hpp"
#include "sluice/host_gl/screen.hpp"

namespace sluice::cli {

/// The images of one frame as read from GL; what the frame does not have stays empty.
struct FrameLayers {
    host::Pixels beauty;                          ///< after the composite, sRGB-encoded
    std::optional<host::Pixels> host_colour;      ///< before the composite, sRGB-encoded
    std::optional<host::Pixels> host_depth;       ///< before the composite, window depth
    std::optional<host::Pixels> fluid_colour;     ///< sRGB-encoded, not premultiplied
    std::optional<host::Pixels> fluid_depth;      ///< window depth, 1 where there is no fluid
    std::optional<host::Pixels> fluid_normal;     ///< eye space
    std::optional<host::Pixels> fluid_thickness;  ///< metres
};

/// R G B A (linear); host.R host.G host.B (linear), host.Z (metres, +inf where nothing was drawn); fluid.R fluid.G
/// fluid.B fluid.A (linear, premultiplied as OpenEXR has it), fluid.Z (metres, +inf where there is no fluid); normal.X
/// normal.Y normal.Z (0 where there is no fluid); thickness.Y (metres).
[[nodiscard]] LayeredImage layeredImage(const FrameLayers& layers, float near_plane, float far_plane);

}  // namespace sluice::cli
