// SPDX-License-Identifier: MIT
#include "sluice/defaults.hpp"

#include <array>
#include <cstddef>

namespace sluice {

SluiceFluid defaultFluid() {
    SluiceFluid fluid{};
    // Clear water takes red first (Pope & Fry 1997: 0.34, 0.057, 0.009 per metre at 650, 550, 450 nm). A pool of half a
    // metre would look like glass with those, so this is several times as dense; tuned on samples/courtyard.json.
    fluid.absorption[0] = 1.7F;
    fluid.absorption[1] = 0.36F;
    fluid.absorption[2] = 0.18F;
    fluid.scatter_colour[0] = 0.010F;
    fluid.scatter_colour[1] = 0.055F;
    fluid.scatter_colour[2] = 0.075F;
    fluid.index_of_refraction = 1.33F;
    // Half its peak at 1.5 degrees of the normal: about the disc that the sky draws (1 to 2.5 degrees, halved by the
    // mirror). On a calm pool whose slopes differ by few degrees a broader lobe (250: 4.3 degrees) is a milky patch.
    fluid.specular_power = 2000.0F;
    fluid.splat_radius = 1.5F;
    fluid.filter = SLUICE_FILTER_NARROW_RANGE;
    fluid.filter_iterations = 3;
    fluid.filter_range = 10.0F;
    fluid.filter_clamp = 1.0F;
    fluid.filter_sigma = 1.5F;
    fluid.filter_max_pixels = 64;
    fluid.thickness_scale = 0.5F;
    fluid.thickness_blur = 1.5F;
    fluid.refraction = 1;
    fluid.reflection = 1;
    fluid.view = SLUICE_VIEW_FLUID;
    fluid.ellipsoids = 1;  // where a simulation has shaped them
    fluid.foam = 1.0F;     // where a simulation has made any
    return fluid;
}

SluiceSky defaultSky() {
    SluiceSky sky{};
    const std::array<float, 3> zenith{0.10F, 0.24F, 0.58F};
    const std::array<float, 3> horizon{0.60F, 0.72F, 0.85F};
    const std::array<float, 3> ground{0.20F, 0.18F, 0.15F};
    const std::array<float, 3> to_sun{0.5017864F, 0.7754881F,
                                      0.3831823F};  // beyond the pool as the camera sees it: the water glitters
    // Water mirrors 2 % of it head-on: a fiftieth of this must still be white for a glint to look like the sun.
    const std::array<float, 3> sun{60.0F, 55.0F, 45.0F};
    for (std::size_t i = 0; i < 3; ++i) {
        sky.zenith[i] = zenith[i];
        sky.horizon[i] = horizon[i];
        sky.ground[i] = ground[i];
        sky.to_sun[i] = to_sun[i];
        sky.sun_radiance[i] = sun[i];
    }
    return sky;
}

}  // namespace sluice
