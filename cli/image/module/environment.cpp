// SPDX-License-Identifier: MIT
#include "image/module/functions.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cmath>

#include "image/colour.hpp"
#include "sluice/plugin.h"

namespace sluice::cli::images {
namespace {

constexpr int kMaxSide = SLUICE_MAX_EXTENT;  ///< a map of that size is 3 GiB in floats; larger is a mistake

Error bad(const std::filesystem::path& path, std::string detail, std::string remedy) {
    return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(), std::move(detail), std::move(remedy)};
}

Status checkSpec(const std::filesystem::path& path, const OIIO::ImageSpec& spec) {
    if (spec.width < 2 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide) {
        return bad(path,
                   fmt::format("expected 2x1 to {0}x{0} pixels, found {1}x{2}", kMaxSide, spec.width, spec.height),
                   "use a smaller map");
    }
    if (spec.nchannels < 1) {
        return bad(path, "has no channels", "use an RGB image");
    }
    return {};
}

}  // namespace

Result<Environment> loadEnvironment(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) {
        return bad(path, fmt::format("cannot be read as an image: {}", OIIO::geterror()),
                   "the scene's \"environment\" must be a latitude-longitude image");
    }
    const OIIO::ImageSpec spec = input->spec();
    if (const Status status = checkSpec(path, spec); !status) {
        return status.error();
    }
    const auto channels = static_cast<std::size_t>(spec.nchannels >= 3 ? 3 : 1);
    Environment map{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), {}};
    const std::size_t texels = std::size_t{map.width} * map.height;
    std::vector<float> read(texels * channels);
    if (!input->read_image(0, 0, 0, static_cast<int>(channels), OIIO::TypeDesc::FLOAT, read.data())) {
        return bad(path, fmt::format("cannot be read to its end: {}", input->geterror()), "is the file complete?");
    }
    const bool encoded = !spec.format.is_floating_point();
    map.pixels.resize(texels * 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const std::size_t texel = i / 3;
        const float value = read[channels == 3 ? i : texel];
        if (!std::isfinite(value) || value < 0.0F) {
            return bad(path,
                       fmt::format("pixel ({}, {}): expected finite light >= 0, found {}", texel % map.width,
                                   texel / map.width, value),
                       "repair the map");
        }
        map.pixels[i] = encoded ? srgbToLinear(value) : value;
    }
    return map;
}

}  // namespace sluice::cli::images
