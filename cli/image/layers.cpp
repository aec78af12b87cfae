// SPDX-License-Identifier: MIT
#include "image/layers.hpp"

#include <utility>

#include "image/colour.hpp"

namespace sluice::cli {
namespace {

using host::Pixels;

/// One channel of `pixels` through `map`, or `absent` where the texture has no such channel.
template <typename Map>
std::vector<float> channel(const Pixels& pixels, std::uint32_t index, const Map& map) {
    const std::size_t texels = std::size_t{pixels.width} * pixels.height;
    std::vector<float> values(texels);
    for (std::size_t i = 0; i < texels; ++i) {
        values[i] = map(pixels.values[i * pixels.channels + index]);
    }
    return values;
}

void addRgb(LayeredImage& image, const std::string& prefix, const Pixels& pixels) {
    constexpr const char* kNames[3] = {"R", "G", "B"};
    for (std::uint32_t c = 0; c < 3; ++c) {
        image.channels.push_back({prefix + kNames[c], true, channel(pixels, c, srgbToLinear)});
    }
}

void premultiply(LayeredImage& image, std::size_t first, const std::vector<float>& alpha) {
    for (std::size_t c = first; c < first + 3; ++c) {
        for (std::size_t i = 0; i < alpha.size(); ++i) {
            image.channels[c].values[i] *= alpha[i];
        }
    }
}

}  // namespace

LayeredImage layeredImage(const FrameLayers& layers, float near_plane, float far_plane) {
    const auto metres = [near_plane, far_plane](float depth) { return linearDepth(depth, near_plane, far_plane); };
    const auto same = [](float value) { return value; };
    LayeredImage image{layers.beauty.width, layers.beauty.height, {}};
    addRgb(image, "", layers.beauty);
    // The back buffer's own alpha means nothing; the picture is opaque.
    image.channels.push_back({"A", true, channel(layers.beauty, 0, [](float) { return 1.0F; })});
    if (layers.host_colour) {
        addRgb(image, "host.", *layers.host_colour);
    }
    if (layers.host_depth) {
        image.channels.push_back({"host.Z", false, channel(*layers.host_depth, 0, metres)});
    }
    if (layers.fluid_colour) {
        const std::size_t first = image.channels.size();
        addRgb(image, "fluid.", *layers.fluid_colour);
        std::vector<float> alpha = channel(*layers.fluid_colour, 3, same);
        premultiply(image, first, alpha);
        image.channels.push_back({"fluid.A", true, std::move(alpha)});
    }
    if (layers.fluid_depth) {
        image.channels.push_back({"fluid.Z", false, channel(*layers.fluid_depth, 0, metres)});
    }
    if (layers.fluid_normal) {
        image.channels.push_back({"normal.X", true, channel(*layers.fluid_normal, 0, same)});
        image.channels.push_back({"normal.Y", true, channel(*layers.fluid_normal, 1, same)});
        image.channels.push_back({"normal.Z", true, channel(*layers.fluid_normal, 2, same)});
    }
    if (layers.fluid_thickness) {
        image.channels.push_back({"thickness.Y", false, channel(*layers.fluid_thickness, 0, same)});
    }
    return image;
}

}  // namespace sluice::cli
