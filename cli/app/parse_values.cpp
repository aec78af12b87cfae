// SPDX-License-Identifier: MIT
#include "app/parse_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>

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

namespace {

struct FaultNumbers {
    std::uint64_t frame = 0, value = 0;
};

/// What stands behind the kind; `text` has an '@'.
Result<FaultNumbers> parseFaultNumbers(std::string_view text) {
    const std::size_t at = text.find('@');
    const std::size_t equals = std::min(text.find('=', at), text.size());
    const std::int64_t frame = whole(text.substr(at + 1, equals - at - 1));
    if (frame < 1) {
        return badValue("--fault", "a frame behind the @ (a whole number; frames count from 1)", text);
    }
    const std::int64_t value = equals < text.size() ? whole(text.substr(equals + 1)) : 0;
    if (value < 0) {
        return badValue("--fault", fmt::format("a VALUE behind the = from 0 to {}", INT64_MAX), text);
    }
    return FaultNumbers{static_cast<std::uint64_t>(frame), static_cast<std::uint64_t>(value)};
}

}  // namespace

bool namesHostFault(std::string_view text) {
    const std::string_view name = text.substr(0, text.find_first_of("@/="));
    return std::any_of(host::kHostFaultNames.begin(), host::kHostFaultNames.end(),
                       [&](const auto& one) { return one.first == name; });
}

Result<host::HostFault> parseHostFault(std::string_view text) {
    const std::string_view what = text.substr(0, text.find_first_of("@="));
    const std::string_view name = what.substr(0, what.find('/'));
    const auto* kind = std::find_if(host::kHostFaultNames.begin(), host::kHostFaultNames.end(),
                                    [&](const auto& one) { return one.first == name; });
    if (kind == host::kHostFaultNames.end() || text.substr(what.size(), 1) != "@") {
        return badValue("--fault", "KIND@FRAME[=VALUE] of a host fault (docs/cli.md)", text);
    }
    if (name != what) {
        return badValue("--fault", fmt::format("{} without a direction, for it is no fault of the hand-off", name),
                        text);
    }
    const Result<FaultNumbers> numbers = parseFaultNumbers(text);
    if (!numbers) {
        return numbers.error();
    }
    return host::HostFault{kind->second, numbers.value().frame, numbers.value().value};
}

Result<host::FaultPlan> parseFault(std::string_view text) {
    const std::size_t at = text.find('@');
    const std::string_view what = text.substr(0, at);
    const std::size_t slash = what.find('/');
    const std::string_view name = what.substr(0, slash);
    const auto* kind = std::find_if(host::kFaultNames.begin(), host::kFaultNames.end(),
                                    [&](const auto& one) { return one.first == name; });
    const std::string_view side = slash == std::string_view::npos ? std::string_view{} : what.substr(slash + 1);
    const bool side_known =
        slash == std::string_view::npos || side == "to-renderer" || side == "to-host" || side == "simulation";
    if (kind == host::kFaultNames.end() || at == std::string_view::npos || !side_known) {
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
    const Result<FaultNumbers> numbers = parseFaultNumbers(text);
    if (!numbers) {
        return numbers.error();
    }
    host::FaultPlan plan;
    plan.kind = kind->second;
    plan.frame = numbers.value().frame;
    plan.value = numbers.value().value;
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
