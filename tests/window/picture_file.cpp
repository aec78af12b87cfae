// SPDX-License-Identifier: MIT
#include "picture_file.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

namespace window::test {

Rgb readPng(const std::filesystem::path& path) {
    Rgb out;
    int channels = 0;
    stbi_uc* texels = stbi_load(path.c_str(), &out.width, &out.height, &channels, 3);
    if (texels == nullptr) {
        return {};
    }
    out.values.assign(texels, texels + static_cast<std::ptrdiff_t>(out.width) * out.height * 3);
    stbi_image_free(texels);
    return out;
}

}  // namespace window::test
