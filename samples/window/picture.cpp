// SPDX-License-Identifier: MIT
#include "picture.hpp"

#include <SDL_opengl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

namespace window {

std::string writeScreenshot(const std::filesystem::path& path, glm::ivec2 size) {
    constexpr int kChannels = 3;
    const auto row = static_cast<std::size_t>(size.x) * kChannels;
    std::vector<unsigned char> rows(row * static_cast<std::size_t>(size.y));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    // OpenGL's first row is the lowest: the last one, and upwards from there.
    std::vector<unsigned char> png;
    const auto append = [](void* to, void* data, int count) {
        const auto* bytes = static_cast<unsigned char*>(data);
        static_cast<std::vector<unsigned char>*>(to)->insert(static_cast<std::vector<unsigned char>*>(to)->end(), bytes,
                                                             bytes + count);
    };
    const unsigned char* top = rows.data() + rows.size() - row;
    if (stbi_write_png_to_func(append, &png, size.x, size.y, kChannels, top, -static_cast<int>(row)) == 0) {
        return path.string() + ": the picture cannot be encoded";
    }
    const std::filesystem::path beside = path.string() + "." + std::to_string(::getpid()) + ".part";
    std::ofstream file(beside, std::ios::binary);
    file.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    file.close();
    std::error_code failed;
    if (file) {
        std::filesystem::rename(beside, path, failed);
    }
    if (!file || failed) {
        std::error_code ignored;
        std::filesystem::remove(beside, ignored);
        return path.string() + ": cannot be written (" +
               (failed ? failed.message() : "does the folder exist, and is there room?") + ")";
    }
    return "";
}

std::filesystem::path freeName() {
    for (int number = 1;; ++number) {
        std::array<char, 32> name{};
        std::snprintf(name.data(), name.size(), "window_%04d.png", number);
        std::error_code ignored;
        if (!std::filesystem::exists(name.data(), ignored)) {
            return name.data();
        }
    }
}

}  // namespace window
