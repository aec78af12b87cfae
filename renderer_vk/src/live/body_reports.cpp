// SPDX-License-Identifier: MIT
#include "live/body_reports.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sluice/abi_sizes.hpp"

namespace sluice::vk {
namespace {

void put(float (&to)[3], const Vector& from) {
    std::transform(from.begin(), from.end(), &to[0], [](double part) { return static_cast<float>(part); });
}

SluiceBodyState reportOf(const BodyState& state, const Vector& force, const Vector& torque) {
    SluiceBodyState out{};
    put(out.centre, state.centre);
    std::transform(state.turn.begin(), state.turn.end(), &out.turn[0],
                   [](double part) { return static_cast<float>(part); });
    put(out.velocity, state.velocity);
    put(out.spin, state.spin);
    put(out.force, force);
    put(out.torque, torque);
    return out;
}

}  // namespace

BodyReports::BodyReports(std::size_t values, std::span<const BodyState> start) : pushes_(start.size()), kept_(values) {
    close(0, start);
}

void BodyReports::add(std::span<const BodyState> bodies, double seconds) {
    seconds_ += seconds;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        pushes_[i].force = plus(pushes_[i].force, times(seconds, bodies[i].force));
        pushes_[i].torque = plus(pushes_[i].torque, times(seconds, bodies[i].torque));
    }
}

void BodyReports::close(std::uint64_t value, std::span<const BodyState> bodies) {
    auto report = sized<SluiceBodies>();
    report.count = static_cast<std::uint32_t>(bodies.size());
    report.value = value;
    const double share = seconds_ > 0.0 ? 1.0 / seconds_ : 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        report.bodies[i] = reportOf(bodies[i], times(share, pushes_[i].force), times(share, pushes_[i].torque));
    }
    std::fill(pushes_.begin(), pushes_.end(), Push{});
    seconds_ = 0.0;
    const std::lock_guard lock(mutex_);
    kept_[value % kept_.size()] = last_ = report;
}

Result<SluiceBodies> BodyReports::at(std::uint64_t value) const {
    const std::lock_guard lock(mutex_);
    if (value == 0) {
        return last_;
    }
    const SluiceBodies& report = kept_[value % kept_.size()];
    if (report.value == value) {
        return report;
    }
    if (value > last_.value) {
        return Error{SLUICE_NOT_READY, "simulation_bodies",
                     fmt::format("value {} has not been simulated yet, the last is {}", value, last_.value),
                     "wait for it with simulation_wait"};
    }
    return Error{
        SLUICE_ERROR_INVALID_ARGUMENT, "simulation_bodies",
        fmt::format("value {} is kept no more: of {} values, the last {} are", value, last_.value, kept_.size()),
        "ask before frames_in_flight + 1 values more are asked for"};
}

}  // namespace sluice::vk
