// SPDX-License-Identifier: MIT
#include "image/module/functions.hpp"

#include <OpenImageIO/imageio.h>

#include <cassert>

#include "image/atomic_file.hpp"

namespace sluice::cli::images {

Status writeExr(const std::filesystem::path& path, const LayeredImage& image) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) {
        return file.error();
    }
    const std::size_t texels = std::size_t{image.width} * image.height;
    const std::size_t count = image.channels.size();
    OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height), static_cast<int>(count),
                         OIIO::TypeDesc::FLOAT);
    spec.channelnames.clear();
    spec.alpha_channel = -1;
    spec.z_channel = -1;
    std::vector<float> interleaved(texels * count);
    for (std::size_t c = 0; c < count; ++c) {
        const Channel& channel = image.channels[c];
        assert(channel.values.size() == texels);
        spec.channelnames.push_back(channel.name);
        spec.channelformats.emplace_back(channel.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
        if (channel.name == "A") {
            spec.alpha_channel = static_cast<int>(c);
        }
        for (std::size_t i = 0; i < texels; ++i) {
            interleaved[i * count + c] = channel.values[i];
        }
    }
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("DateTime", "");  // else OpenImageIO writes the hour, and no two renders are the same file
    spec.attribute("Software", "sluice " SLUICE_VERSION);
    if (image.camera) {
        // OpenEXR multiplies row vectors with matrices of rows, which are the same 16 numbers.
        spec.attribute("worldtocamera", OIIO::TypeMatrix, image.camera->view.data());
        spec.attribute("sluice:projection", OIIO::TypeMatrix, image.camera->projection.data());
        spec.attribute("sluice:near", image.camera->near_plane);
    }
    const auto output = OIIO::ImageOutput::create("openexr");
    if (!output) {
        return Error{SLUICE_ERROR_UNSUPPORTED, path.string(), OIIO::geterror(), "install an OpenImageIO with OpenEXR"};
    }
    if (!output->open(file.value().temporary().string(), spec) ||
        !output->write_image(OIIO::TypeDesc::FLOAT, interleaved.data()) || !output->close()) {
        return Error{SLUICE_ERROR_INTERNAL, path.string(), output->geterror(), "may the folder be written to?"};
    }
    return file.value().commit();
}

}  // namespace sluice::cli::images
