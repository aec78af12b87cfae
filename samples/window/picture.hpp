// SPDX-License-Identifier: MIT
// What the window shows, as a PNG file.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <string>

namespace window {

/// Of the framebuffer that is bound, before it is shown. The file is there whole or not at all; what went wrong, or "".
[[nodiscard]] std::string writeScreenshot(const std::filesystem::path& path, glm::ivec2 size);

/// window_0001.png and so on: the first that is not there yet.
[[nodiscard]] std::filesystem::path freeName();

}  // namespace window
