// SPDX-License-Identifier: MIT
#include "app/parse_values.hpp"

#include <fmt/format.h>

#include <algorithm>
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

Result<std::uint64_t> parseWhole(std::string_view what, std::string_view text) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || stop != end) {
        return badValue(what, "a whole number, 0 or more", text);
    }
    return value;
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

Result<std::uint32_t> parseFramesInFlight(std::string_view text) {
    const std::int64_t frames = whole(text);
    if (frames < 1 || frames > SLUICE_MAX_FRAMES_IN_FLIGHT) {
        return badValue("--frames-in-flight", fmt::format("1 to {}", SLUICE_MAX_FRAMES_IN_FLIGHT), text);
    }
    return static_cast<std::uint32_t>(frames);
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

bool namesHostFault(std::string_view text) {
    const std::string_view name = text.substr(0, text.find('@'));
    return std::any_of(host::kHostFaultNames.begin(), host::kHostFaultNames.end(),
                       [&](const auto& one) { return one.first == name; });
}

Result<host::HostFault> parseHostFault(std::string_view text) {
    const std::size_t at = std::min(text.find('@'), text.size());
    const std::size_t equals = std::min(text.find('=', at), text.size());
    const auto* kind = std::find_if(host::kHostFaultNames.begin(), host::kHostFaultNames.end(),
                                    [&](const auto& one) { return one.first == text.substr(0, at); });
    const std::int64_t frame = at < text.size() ? whole(text.substr(at + 1, equals - at - 1)) : kNotWhole;
    const std::int64_t value = equals < text.size() ? whole(text.substr(equals + 1)) : 0;
    if (kind == host::kHostFaultNames.end() || frame < 1 || value < 0) {
        return badValue("--fault", "KIND@FRAME[=VALUE] of a host fault (docs/cli.md)", text);
    }
    return host::HostFault{kind->second, static_cast<std::uint64_t>(frame), static_cast<std::uint64_t>(value)};
}

Result<host::FaultPlan> parseFault(std::string_view text) {
    const std::size_t at = text.find('@');
    const std::size_t equals = text.find('=', at == std::string_view::npos ? 0 : at);
    const std::string_view what = text.substr(0, at);
    const std::size_t slash = what.find('/');
    const std::string_view name = what.substr(0, slash);
    const auto* kind = std::find_if(host::kFaultNames.begin(), host::kFaultNames.end(),
                                    [&](const auto& one) { return one.first == name; });
    const std::int64_t frame =
        at == std::string_view::npos
            ? kNotWhole
            : whole(text.substr(at + 1, equals == std::string_view::npos ? equals : equals - at - 1));
    const std::int64_t value = equals == std::string_view::npos ? 0 : whole(text.substr(equals + 1));
    const std::string_view side = slash == std::string_view::npos ? std::string_view{} : what.substr(slash + 1);
    const bool side_known =
        slash == std::string_view::npos || side == "to-renderer" || side == "to-host" || side == "simulation";
    if (kind == host::kFaultNames.end() || frame < 1 || value < 0 || !side_known) {
        std::string kinds;
        for (const auto& [one, ignored] : host::kFaultNames) {
            kinds += fmt::format("{}{}", kinds.empty() ? "" : ", ", one);
        }
        for (const auto& [one, ignored] : host::kHostFaultNames) {
            kinds += fmt::format(", {}", one);
        }
        return badValue("--fault",
                        fmt::format("KIND[/to-renderer|/to-host|/simulation]@FRAME[=VALUE], KIND one of {}", kinds),
                        text);
    }
    host::FaultPlan plan;
    plan.kind = kind->second;
    plan.frame = static_cast<std::uint64_t>(frame);
    plan.value = static_cast<std::uint64_t>(value);
    const bool about_waits = plan.kind == host::FaultKind::SkipWait || plan.kind == host::FaultKind::EarlyReuse;
    plan.direction =
        side == "to-host" || (side.empty() && about_waits) ? SLUICE_RENDERER_TO_HOST : SLUICE_HOST_TO_RENDERER;
    if (side == "simulation") {
        plan.direction = SLUICE_SIMULATION_TO_RENDERER;
    }
    if (!host::possible(plan.kind, plan.direction)) {
        return badValue("--fault", fmt::format("{} in the other direction", name), text);
    }
    return plan;
}

Result<double> parseDeadline(std::string_view text) {
    double seconds = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, seconds);
    if (failure != std::errc{} || stop != end || !(seconds > 0.0 && seconds <= 3600.0)) {
        return badValue("--deadline", "seconds above 0, at most 3600", text);
    }
    return seconds;
}

}  // namespace sluice::cli
