// SPDX-License-Identifier: MIT
#include "app/looks.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace sluice::cli {

SluiceFluid firstLook(const scene::Scene& scene) {
    SluiceFluid look = scene.fluid;
    if (!scene.simulation.fluids.empty()) {
        const scene::Vec3& absorption = scene.simulation.fluids.front().absorption;
        std::copy(absorption.begin(), absorption.end(), std::begin(look.absorption));
    }
    return look;
}

std::vector<SluiceLook> otherLooks(const scene::Scene& scene) {
    std::vector<SluiceLook> looks;
    bool apart = false;
    const std::vector<scene::FluidKind>& fluids = scene.simulation.fluids;
    for (std::size_t i = 1; i < fluids.size(); ++i) {
        SluiceLook& look = looks.emplace_back();
        std::copy(fluids[i].absorption.begin(), fluids[i].absorption.end(), std::begin(look.absorption));
        apart = apart || fluids[i].absorption != fluids.front().absorption;
    }
    return apart ? looks : std::vector<SluiceLook>{};
}

std::uint32_t nearestFluid(const std::vector<scene::FluidKind>& fluids, const float* colour) {
    const auto distance = [colour](const scene::FluidKind& fluid) {
        double square = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double off = double{fluid.colour.at(channel)} - double{colour[channel]};
            square += off * off;
        }
        return square;
    };
    const auto nearest = std::min_element(fluids.begin(), fluids.end(),
                                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    return static_cast<std::uint32_t>(nearest - fluids.begin());
}

std::vector<std::uint32_t> fluidsOf(const particles::ParticleSet& set, const scene::Scene& scene) {
    const std::vector<scene::FluidKind>& fluids = scene.simulation.fluids;
    std::vector<std::uint32_t> numbers;
    if (fluids.size() < 2 || set.colour.empty()) {
        return numbers;
    }
    numbers.reserve(set.count());
    for (std::size_t i = 0; i < set.colour.size(); i += 3) {
        numbers.push_back(nearestFluid(fluids, &set.colour[i]));
    }
    return numbers;
}

}  // namespace sluice::cli
