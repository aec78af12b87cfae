// SPDX-License-Identifier: MIT
#include "builder.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace sluice::particles {

bool usableRadius(float radius) {
    return radius >= kMinRadius && radius <= kMaxRadius;
}

bool usableCoordinate(float value) {
    return std::abs(value) <= kMaxCoordinate;
}

namespace {

bool usable(const Triple& value) {
    return std::ranges::all_of(value, usableCoordinate);
}

void append(std::vector<float>& out, const Triple& value) {
    out.insert(out.end(), value.begin(), value.end());
}

Error badRadius(const std::string& name, float value, Place place) {
    return failure(name, place, fmt::format("a particle radius from {} to {} m", kMinRadius, kMaxRadius),
                   fmt::format("{}", value), "positions and radius are in metres; scale the set when you export it");
}

}  // namespace

void Builder::reserve(std::size_t count, bool velocity, bool colour) {
    set_.position.reserve(3 * count);
    set_.velocity.reserve(velocity ? 3 * count : 0);
    set_.colour.reserve(colour ? 3 * count : 0);
}

Error Builder::badTriple(const char* what, const Triple& value, Place place, std::size_t index) const {
    return failure(name_, place, fmt::format("{} of particle {} finite and within ±{:g}", what, index, kMaxCoordinate),
                   fmt::format("({}, {}, {})", value[0], value[1], value[2]),
                   "the simulation may have blown up at this frame, or the file is damaged");
}

Status Builder::addPosition(const Triple& value, Place place) {
    if (!usable(value)) {
        return badTriple("the position", value, place, set_.position.size() / 3);
    }
    append(set_.position, value);
    return {};
}

Status Builder::addVelocity(const Triple& value, Place place) {
    if (!usable(value)) {
        return badTriple("the velocity", value, place, set_.velocity.size() / 3);
    }
    append(set_.velocity, value);
    return {};
}

Status Builder::addColour(const Triple& value, Place place) {
    if (!usable(value)) {
        return badTriple("the colour", value, place, set_.colour.size() / 3);
    }
    for (const float channel : value) {
        set_.colour.push_back(std::clamp(channel, 0.0F, 1.0F));
    }
    return {};
}

Status Builder::setRadius(float value, Place place) {
    if (!usableRadius(value)) {
        return badRadius(name_, value, place);
    }
    set_.radius = value;
    return {};
}

Status Builder::addRadius(float value, Place place) {
    if (!usableRadius(value)) {
        Error error = badRadius(name_, value, place);
        error.detail += fmt::format(" for particle {}", radius_count_);
        return error;
    }
    if (radius_count_ == 0) {
        radius_first_ = value;
    }
    radius_varies_ = radius_varies_ || value != radius_first_;
    radius_sum_ += static_cast<double>(value);
    ++radius_count_;
    return {};
}

ParticleSet Builder::finish() {
    if (radius_count_ > 0) {
        set_.radius =
            radius_varies_ ? static_cast<float>(radius_sum_ / static_cast<double>(radius_count_)) : radius_first_;
    }
    return std::move(set_);
}

Status checkCount(const std::string& name, std::uint64_t count, Place place) {
    if (count > kMaxParticles) {
        return failure(name, place, fmt::format("at most {} particles", kMaxParticles), fmt::format("{}", count),
                       "the header is damaged, or the set must be split");
    }
    return {};
}

}  // namespace sluice::particles
