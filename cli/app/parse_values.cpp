// SPDX-License-Identifier: MIT
#include "app/parse_values.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace sluice::cli {
namespace {

constexpr std::int64_t kNotWhole = -1;

/// All of `text` as a whole number without sign, blanks or leftovers; else kNotWhole.
std::int64_t whole(std::string_view text) {
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, value);
    return failure == std::errc{} && stop == end && text.front() != '-' ? value : kNotWhole;
}

}  // namespace

Error badValue(std::string_view what, std::string_view expected, std::string_view found) {
    return Error{SLUICE_ERROR_INVALID_ARGUMENT, std::string(what),
                 fmt::format("expected {}, found \"{}\"", expected, found), ""};
}

Result<scene::FrameRange> parseFrameRange(std::string_view text) {
    const std::size_t dots = text.find("..");
    const std::string_view left = text.substr(0, dots);
    const std::string_view right = dots == std::string_view::npos ? left : text.substr(dots + 2);
    const std::int64_t first = whole(left);
    const std::int64_t last = whole(right);
    if (first < 0 || last < first || last > scene::kMaxFrame) {
        return badValue("--frames", fmt::format("A..B with 0 <= A <= B <= {}", scene::kMaxFrame), text);
    }
    return scene::FrameRange{first, last};
}

Result<scene::Size> parseSize(std::string_view text) {
    const std::size_t cross = text.find('x');
    if (cross != std::string_view::npos) {
        const std::int64_t width = whole(text.substr(0, cross));
        const std::int64_t height = whole(text.substr(cross + 1));
        if (width >= 1 && height >= 1 && width <= scene::kMaxSize && height <= scene::kMaxSize) {
            return scene::Size{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
        }
    }
    return badValue("--size", fmt::format("WxH, each 1 to {}", scene::kMaxSize), text);
}

Result<std::uint32_t> parseImageSets(std::string_view text) {
    const std::int64_t sets = whole(text);
    if (sets < 1 || sets > SLUICE_MAX_IMAGE_SETS) {
        return badValue("--image-sets", fmt::format("1 to {}", SLUICE_MAX_IMAGE_SETS), text);
    }
    return static_cast<std::uint32_t>(sets);
}

Result<float> parseRadius(std::string_view text) {
    float radius = 0.0F;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, radius);
    if (failure != std::errc{} || stop != end || !std::isfinite(radius) || radius <= 0.0F) {
        return badValue("--radius", "metres above 0", text);
    }
    return radius;
}

}  // namespace sluice::cli
