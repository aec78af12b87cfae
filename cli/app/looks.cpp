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

std::vector<std::uint32_t> fluidsOf(const particles::ParticleSet& set, const scene::Scene& scene) {
    const std::vector<scene::FluidKind>& fluids = scene.simulation.fluids;
    std::vector<std::uint32_t> numbers;
    if (fluids.size() < 2 || set.colour.empty()) {
        return numbers;
    }
    numbers.reserve(set.count());
    for (std::size_t i = 0; i < set.colour.size(); i += 3) {
        const auto distance = [&](const scene::FluidKind& fluid) {
            float square = 0.0F;
            for (std::size_t k = 0; k < 3; ++k) {
                const float off = set.colour[i + k] - fluid.colour.at(k);
                square += off * off;
            }
            return square;
        };
        const auto nearest = std::min_element(fluids.begin(), fluids.end(),
                                              [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
        numbers.push_back(static_cast<std::uint32_t>(nearest - fluids.begin()));
    }
    return numbers;
}

}  // namespace sluice::cli
