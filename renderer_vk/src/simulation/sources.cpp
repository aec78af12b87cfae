// SPDX-License-Identifier: MIT
#include "simulation/sources.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/vector.hpp"

namespace sluice::vk {
namespace {

/// Along the width: horizontal, or +x for an opening that looks up or down.
Vector widthAxis(const Vector& direction) {
    const Vector level = cross({0, 1, 0}, direction);
    return std::hypot(level[0], level[2]) > 1e-3 ? unit(level) : unit(cross(cross(direction, {1, 0, 0}), direction));
}

/// Lattice places along a length that keep a radius from its ends.
int along(double length, double spacing) {
    return std::max(1, static_cast<int>(std::floor(length / spacing + 1e-3)));
}

std::array<float, 4> with(const Triple& v, float w) {
    return {v[0], v[1], v[2], w};
}

}  // namespace

std::vector<Triple> outletSites(const Emitter& emitter, float radius) {
    const double spacing = 2.0 * double{radius};
    const Vector out = unit(wide(emitter.direction));
    const Vector u = widthAxis(out);
    const Vector v = cross(out, u);
    const int wide = along(double{emitter.width}, spacing);
    const int high = along(double{emitter.height}, spacing);
    // Half a radius from the rim: so the number of places is nearest to what the area asks for.
    const double rim = std::max(double{emitter.width} / 2.0 - 0.499 * double{radius}, 0.0);
    std::vector<Triple> sites;
    for (int j = 0; j < high; ++j) {
        for (int i = 0; i < wide; ++i) {
            const double a = spacing * (i - (wide - 1) / 2.0);
            const double b = spacing * (j - (high - 1) / 2.0);
            if (emitter.disc && std::hypot(a, b) > rim) {
                continue;
            }
            Triple site{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                site.at(axis) = static_cast<float>(double{emitter.centre.at(axis)} + a * u.at(axis) + b * v.at(axis));
            }
            sites.push_back(site);
        }
    }
    if (sites.empty()) {  // a disc of two places across, none of which keeps to its rim
        sites.push_back(emitter.centre);
    }
    return sites;
}

double layerPeriod(const Emitter& emitter, std::size_t sites, float radius) {
    const double densest = 2.0 * double{radius} / double{emitter.speed};
    return emitter.rate > 0.0F ? std::max(static_cast<double>(sites) / double{emitter.rate}, densest) : densest;
}

void addBirths(const Emitter& emitter, std::span<const Triple> sites, float radius, const Triple& gravity, double from,
               double to, std::vector<Birth>& births) {
    const double period = layerPeriod(emitter, sites.size(), radius);
    const auto start = double{emitter.start};
    const double stop = emitter.stop > 0.0F ? double{emitter.stop} : 1e300;
    const auto timeOf = [&](double layer) { return start + layer * period; };
    double layer = std::max(0.0, std::floor((from - start) / period) - 1.0);
    while (timeOf(layer) < from) {
        layer += 1.0;
    }
    const Vector out = unit(wide(emitter.direction));
    for (; timeOf(layer) < std::min(to, stop); layer += 1.0) {
        const double age = to - timeOf(layer);
        Birth birth{};
        birth.fluid = emitter.fluid;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            birth.velocity.at(axis) =
                static_cast<float>(double{emitter.speed} * out.at(axis) + age * double{gravity.at(axis)});
        }
        for (const Triple& site : sites) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                birth.position.at(axis) =
                    static_cast<float>(double{site.at(axis)} + age * double{birth.velocity.at(axis)});
            }
            births.push_back(birth);
        }
    }
}

double strongest(std::span<const ForceField> fields) {
    double sum = 0.0;
    for (const ForceField& field : fields) {
        sum += std::abs(double{field.strength});
    }
    return sum;
}

SourceBlock sourceBlock(const SourceSettings& sources) {
    SourceBlock block{};
    block.number = {static_cast<std::uint32_t>(sources.fields.size()),
                    static_cast<std::uint32_t>(sources.drains.size()),
                    static_cast<std::uint32_t>(sources.emitters.size()), 0};
    for (std::size_t i = 0; i < sources.fields.size(); ++i) {
        const ForceField& field = sources.fields[i];
        const Vector axis = unit(wide(field.axis));
        block.fields.at(i) = {
            with(field.centre, static_cast<float>(field.kind)),
            {static_cast<float>(axis[0]), static_cast<float>(axis[1]), static_cast<float>(axis[2]), field.strength},
            {field.radius > 0.0F ? 1.0F / field.radius : 0.0F, 0, 0, 0}};
    }
    for (std::size_t i = 0; i < sources.drains.size(); ++i) {
        const Drain& drain = sources.drains[i];
        block.drains.at(i) = {with(drain.centre, drain.sphere ? 1.0F : 0.0F), with(drain.half, 0.0F)};
    }
    return block;
}

std::vector<Birth> birthsOf(const SourceSettings& sources, float radius, const Triple& gravity, double from, double to,
                            SourceBlock& block) {
    std::vector<Birth> births;
    for (std::size_t i = 0; i < sources.emitters.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(births.size());
        const std::vector<Triple> sites = outletSites(sources.emitters[i], radius);
        addBirths(sources.emitters[i], sites, radius, gravity, from, to, births);
        // A ball about them, and a spacing more: only who is in it looks at every one of them.
        Vector centre{};
        for (std::size_t k = first; k < births.size(); ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                centre.at(axis) +=
                    double{births[k].position.at(axis)} / static_cast<double>(births.size() - std::size_t{first});
            }
        }
        double reach = 0.0;
        for (std::size_t k = first; k < births.size(); ++k) {
            const Triple& x = births[k].position;
            reach = std::max(reach,
                             std::hypot(double{x[0]} - centre[0], double{x[1]} - centre[1], double{x[2]} - centre[2]));
        }
        block.outlets.at(i) = {{static_cast<float>(centre[0]), static_cast<float>(centre[1]),
                                static_cast<float>(centre[2]), static_cast<float>(reach + 2.0 * double{radius})},
                               {first, static_cast<std::uint32_t>(births.size()), 0, 0}};
    }
    return births;
}

}  // namespace sluice::vk
