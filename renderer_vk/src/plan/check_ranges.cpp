// SPDX-License-Identifier: MIT
#include "plan/check_ranges.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "plan/plan.hpp"

namespace sluice::vk {
namespace {

Error outOfRange(std::string_view field, std::string_view value, std::string_view range) {
    return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("SluiceSceneNeeds.{}", field),
                 fmt::format("{} is out of range", value), fmt::format("give {}", range)};
}

struct Limit {
    std::string_view field;
    float value, low, high;
};

Status checkNumbers(const SluiceFluid& fluid) {
    // The upper limits only catch nonsense; they lie far beyond any fluid.
    const std::array<Limit, 15> limits{{
        {"fluid.absorption[0]", fluid.absorption[0], 0.0F, 1e6F},
        {"fluid.absorption[1]", fluid.absorption[1], 0.0F, 1e6F},
        {"fluid.absorption[2]", fluid.absorption[2], 0.0F, 1e6F},
        {"fluid.scatter_colour[0]", fluid.scatter_colour[0], 0.0F, 1e6F},
        {"fluid.scatter_colour[1]", fluid.scatter_colour[1], 0.0F, 1e6F},
        {"fluid.scatter_colour[2]", fluid.scatter_colour[2], 0.0F, 1e6F},
        {"fluid.index_of_refraction", fluid.index_of_refraction, 1.0F, 10.0F},
        {"fluid.specular_power", fluid.specular_power, 0.0F, 1e6F},
        {"fluid.splat_radius", fluid.splat_radius, 0.01F, 100.0F},
        {"fluid.filter_range", fluid.filter_range, 0.0F, 1e6F},
        {"fluid.filter_clamp", fluid.filter_clamp, 0.0F, 1e6F},
        {"fluid.filter_sigma", fluid.filter_sigma, 0.0F, 1e3F},
        {"fluid.thickness_scale", fluid.thickness_scale, 0.25F, 1.0F},
        {"fluid.thickness_blur", fluid.thickness_blur, 0.0F, 1e3F},
        {"fluid.foam", fluid.foam, 0.0F, 1e3F},
    }};
    for (const Limit& limit : limits) {
        // Negated so that NaN fails as well.
        if (!(limit.value >= limit.low && limit.value <= limit.high)) {
            return outOfRange(limit.field, fmt::format("{}", limit.value),
                              fmt::format("{} to {}", limit.low, limit.high));
        }
    }
    const float scale = fluid.thickness_scale;
    if (scale != 1.0F && scale != 0.5F && scale != 0.25F) {
        return outOfRange("fluid.thickness_scale", fmt::format("{}", scale), "1, 0.5 or 0.25");
    }
    return {};
}

}  // namespace

Status checkRanges(const SluiceSceneNeeds& needs) {
    const auto sizeOk = [](std::uint32_t size) { return size >= 1 && size <= SLUICE_MAX_EXTENT; };
    if (!sizeOk(needs.width) || !sizeOk(needs.height)) {
        return outOfRange("width, height", fmt::format("{}x{}", needs.width, needs.height),
                          fmt::format("1 to {} each", SLUICE_MAX_EXTENT));
    }
    if (needs.fluid.view > SLUICE_VIEW_ECHO) {
        return outOfRange("fluid.view", fmt::format("{}", needs.fluid.view), "a SluiceView");
    }
    if (needs.fluid.view == SLUICE_VIEW_ECHO) {
        return {};  // nothing of the fluid is used
    }
    if (needs.fluid.filter > SLUICE_FILTER_NARROW_RANGE) {
        return outOfRange("fluid.filter", fmt::format("{}", needs.fluid.filter), "a SluiceFilterKind");
    }
    if (needs.fluid.filter_iterations > kMaxFilterIterations) {
        return outOfRange("fluid.filter_iterations", fmt::format("{}", needs.fluid.filter_iterations),
                          fmt::format("0 to {}", kMaxFilterIterations));
    }
    if (needs.fluid.filter_max_pixels > kMaxFilterPixels) {
        return outOfRange("fluid.filter_max_pixels", fmt::format("{}", needs.fluid.filter_max_pixels),
                          fmt::format("0 to {}", kMaxFilterPixels));
    }
    if (needs.other_look_count >= SLUICE_MAX_FLUIDS) {
        return outOfRange("other_look_count", fmt::format("{}", needs.other_look_count),
                          fmt::format("0 to {}", SLUICE_MAX_FLUIDS - 1));
    }
    return checkNumbers(needs.fluid);
}

}  // namespace sluice::vk
