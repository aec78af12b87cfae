// SPDX-License-Identifier: MIT
#include "image/module/functions.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "sluice/plugin.h"

namespace sluice::cli::images {
namespace {

constexpr const char* kRemedy =
    "render one: sluice render SCENE --no-fluid --frames 1..1 -o FILE.png --layers FILE.exr";

Error bad(const std::filesystem::path& path, std::string detail) {
    return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(), std::move(detail), kRemedy};
}

/// The channel's place; -1: there is none.
int depthChannel(const OIIO::ImageSpec& spec) {
    const int layer = spec.channelindex("host.Z");
    return layer >= 0 ? layer : spec.channelindex("Z");
}

/// As writeExr has it. A matrix of somebody else's has other axes, so all three or none.
Result<std::optional<ImageCamera>> cameraOf(const OIIO::ImageSpec& spec, const std::filesystem::path& path) {
    ImageCamera camera;
    camera.near_plane = spec.get_float_attribute("sluice:near");
    const bool projects = spec.getattribute("sluice:projection", OIIO::TypeMatrix, camera.projection.data());
    if (!projects && camera.near_plane == 0.0F) {
        return std::optional<ImageCamera>{};
    }
    if (!projects || !(camera.near_plane > 0.0F) ||
        !spec.getattribute("worldtocamera", OIIO::TypeMatrix, camera.view.data())) {
        return bad(path, "says in part which camera it is of (worldToCamera, sluice:projection, sluice:near)");
    }
    return std::optional<ImageCamera>{camera};
}

/// A pipe would be waited for.
Status checkThere(const std::filesystem::path& path) {
    std::error_code error;
    const bool regular = std::filesystem::is_regular_file(path, error);
    if (error) {
        return bad(path, error.message());
    }
    return regular ? Status{} : Status{bad(path, "expected a regular file, found a folder or a device")};
}

}  // namespace

Result<DepthLayer> readDepthLayer(const std::filesystem::path& path, bool contents) {
    if (Status status = checkThere(path); !status) {
        return status.error();
    }
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) {
        return bad(path, fmt::format("cannot be read as an image: {}", OIIO::geterror()));
    }
    const OIIO::ImageSpec spec = input->spec();
    constexpr int kMost = SLUICE_MAX_EXTENT;
    if (spec.width < 1 || spec.height < 1 || spec.width > kMost || spec.height > kMost) {
        return bad(path, fmt::format("expected 1 to {} pixels each way, found {}x{}", kMost, spec.width, spec.height));
    }
    const int channel = depthChannel(spec);
    if (channel < 0) {
        return bad(path, "has no channel host.Z, nor Z");
    }
    auto camera = cameraOf(spec, path);
    if (!camera) {
        return camera.error();
    }
    DepthLayer layer{
        static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), camera.value(), {}};
    if (!contents) {
        return layer;
    }
    std::vector<float> rows(std::size_t{layer.width} * layer.height);
    if (!input->read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT, rows.data())) {
        return bad(path, fmt::format("cannot be read to its end: {}", input->geterror()));
    }
    layer.depth.resize(rows.size());
    for (std::size_t y = 0; y < layer.height; ++y) {
        const auto row = rows.begin() + static_cast<std::ptrdiff_t>((layer.height - 1 - y) * layer.width);
        std::copy_n(row, layer.width, layer.depth.begin() + static_cast<std::ptrdiff_t>(y * layer.width));
    }
    return layer;
}

}  // namespace sluice::cli::images
