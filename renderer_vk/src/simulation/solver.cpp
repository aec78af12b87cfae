// SPDX-License-Identifier: MIT
#include "simulation/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "device/one_shot.hpp"
#include "simulation/depth.hpp"
#include "simulation/solver_state.hpp"
#include "simulation/time_step.hpp"
#include "simulation/transfer.hpp"

namespace sluice::vk {
namespace {

/// Supports. Farther, and the particles that the lists were made for are no neighbours any more.
constexpr double kFarthestMove = 1.0;
/// How far a step may be above what its depth allows: between 0.17, below which no column boiled, and 0.24, above which
/// all did, lies a factor of 1.19 in the step.
constexpr double kPatience = 1.06;

double norm(const Triple& v) {
    return std::hypot(double{v[0]}, double{v[1]}, double{v[2]});
}

double fastest(std::span<const float> velocities) {
    double most = 0.0;
    for (std::size_t i = 0; i + 2 < velocities.size(); i += 3) {
        most = std::max(most, norm({velocities[i], velocities[i + 1], velocities[i + 2]}));
    }
    return most;
}

std::vector<Solid> wallsOf(const SimulationSettings& s) {
    std::vector<Solid> walls{planeSolid({1, 0, 0}, s.low),   planeSolid({0, 1, 0}, s.low),
                             planeSolid({0, 0, 1}, s.low),   planeSolid({-1, 0, 0}, s.high),
                             planeSolid({0, -1, 0}, s.high), planeSolid({0, 0, -1}, s.high)};
    const std::vector<Solid> solids = solidsWithin(s);
    walls.insert(walls.end(), solids.begin(), solids.end());
    return walls;
}

Features featuresOf(const SimulationSettings& s) {
    return {s.vorticity > 0.0F, !s.sources.fields.empty(), !s.bodies.empty(), s.tense(), s.meshed(),
            s.seen != nullptr,  !s.fluids.empty(),         deepestAxis(s),    s.kernel};
}

double fastestJet(const SimulationSettings& s) {
    double most = 0.0;
    for (const Emitter& emitter : s.sources.emitters) {
        most = std::max(most, double{emitter.speed});
    }
    return most;
}

/// Who is so fast, for a message.
std::string whoIs(double speed, const SimulationSettings& s, std::span<const BodyState> bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (fastestPoint({&s.bodies[i], 1}, bodies.subspan(i, 1)) >= speed) {
            return fmt::format("body {}", i);
        }
    }
    for (std::size_t i = 0; i < s.sources.emitters.size(); ++i) {
        if (double{s.sources.emitters[i].speed} >= speed) {
            return fmt::format("emitter {}", i);
        }
    }
    return "a particle";
}

}  // namespace

Solver::Solver(std::unique_ptr<State> state) : state_(std::move(state)) {}
Solver::~Solver() = default;

Result<std::unique_ptr<Solver>> Solver::create(const Device& device, const SimulationSettings& settings) {
    if (Status status = checkSettings(settings); !status) {
        return status.error();
    }
    auto state = std::make_unique<State>(device, withoutNeedlessFluids(settings));
    state->settings.solids = solidsWithin(settings);
    state->sources = sourceBlock(settings.sources);
    state->walls = wallsOf(settings);
    state->restartBodies();
    Result<Kernels> kernels = Kernels::create(device, featuresOf(state->settings));
    if (!kernels) {
        return kernels.error();
    }
    state->kernels = std::move(kernels).value();
    Result<Buffer> meshes = uploadMeshes(device, settings.meshed() ? *settings.meshes : DistanceGrid{});
    if (!meshes) {
        return meshes.error();
    }
    state->meshes = std::move(meshes).value();
    Result<Buffer> seen = uploadDepthField(device, settings.seen != nullptr ? *settings.seen : DepthField{});
    if (!seen) {
        return seen.error();
    }
    state->seen = std::move(seen).value();
    state->seen_by = state->seen.buffer();
    return std::unique_ptr<Solver>(new Solver(std::move(state)));
}

Status Solver::setDepthField(const DepthField& field) {
    State& s = *state_;
    if (s.settings.seen == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation: depth field", "the solver was made without one", ""};
    }
    if (Status status = checkDepthField(field, s.settings.radius); !status) {
        return status;
    }
    Result<Buffer> made = uploadDepthField(s.device, field);
    if (!made) {
        return made.error();
    }
    useDepthField(made.value().buffer());
    s.seen = std::move(made).value();
    return {};
}

void Solver::useDepthField(VkBuffer field) {
    State& s = *state_;
    s.seen_by = field;
    if (s.buffers.particles > 0) {
        s.kernels.bind(s.buffers, s.meshes, field);
    }
}

Status Solver::setParticles(std::span<const float> positions, std::span<const float> velocities,
                            std::span<const std::uint32_t> fluids) {
    State& s = *state_;
    // Emitters may be shut now: none is enough where somebody may come.
    const bool none = positions.empty() && velocities.empty() && fluids.empty() && s.opened;
    if (Status status = none ? Status{} : checkParticles(s.settings, positions, velocities, fluids); !status) {
        return status;
    }
    const auto count = static_cast<std::uint32_t>(positions.size() / 3);
    if (Status status = s.makeRoom(count, false); !status) {
        return status;
    }
    s.odd = false;
    s.measurable = s.searched = false;
    s.counts = {count, count, 0, count};
    s.time = 0.0;
    s.depth = 0.0;
    s.restartBodies();
    s.speed = std::max({fastest(velocities), fastestPoint(s.settings.bodies, s.bodies), fastestJet(s.settings)});
    return uploadParticles(s.device, s.buffers, positions, velocities, fluids);
}

Result<StepReport> Solver::step(double seconds) {
    if (!state_->ready() || !(seconds > 0.0 && seconds <= 1.0)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
                     fmt::format("expected particles and a step in (0, 1] s, found {} and {}", count(), seconds), ""};
    }
    Result<StepReport> report = state_->attempt(seconds);
    if (report) {
        state_->keep(report.value());
    }
    return report;
}

Result<AdvanceReport> Solver::advance(double seconds, double longest) {
    State& s = *state_;
    if (!s.ready() || !(seconds > 0.0 && longest > 0.0 && longest <= 1.0)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
                     fmt::format("expected particles, a time > 0 and steps in (0, 1] s, found {}, {} and {}", count(),
                                 seconds, longest),
                     ""};
    }
    const auto h = double{s.settings.support()};
    const StepLimits limits{longest, double{s.settings.cfl} * h,
                            gravityOf(s.settings) + strongest(s.settings.sources.fields)};
    AdvanceReport total;
    total.shortest = longest;
    double left = seconds;
    double most = seconds;  // halved when a step went too far, until the next one that did not
    while (left > 0.0 && total.steps + total.split < kMostSteps) {
        const double wanted = nextStep(
            left, s.speed, {std::min(longest, longestAtDepth(s.settings, s.depth)), limits.reach, limits.acceleration});
        if (left / wanted > kMostSteps) {
            break;
        }
        const double dt = std::min(wanted, most);
        const Result<StepReport> report = s.attempt(dt);
        if (!report) {
            return report.error();
        }
        total.most_neighbours = std::max(total.most_neighbours, report.value().most_neighbours);
        // The depth is that of the step before, or not known yet: a step may have been a little too long for the new
        // one.
        const double at_depth = longestAtDepth(s.settings, report.value().depth);
        const bool deep = dt > kPatience * at_depth;
        if (deep || report.value().move > kFarthestMove * h) {
            ++total.split;
            most = deep ? at_depth : dt / 2.0;
            if (most < longest / 1024.0) {
                break;
            }
            if (s.watch && !s.watch(report.value(), false)) {
                return total;
            }
            continue;
        }
        s.keep(report.value());
        ++total.steps;
        total.born += report.value().born;
        total.blocked += report.value().blocked;
        total.drained += report.value().drained;
        total.shortest = std::min(total.shortest, dt);
        total.speed = std::max(total.speed, s.speed);
        if (s.watch && !s.watch(report.value(), true)) {
            return total;
        }
        left = dt < left * (1.0 - 1e-9) ? left - dt : 0.0;
        most = seconds;
    }
    if (left > 0.0) {
        return Error{
            SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
            fmt::format("no step was stable: after {} steps and {} halvings, {} s of {} are left at a speed of "
                        "{:.3g} m/s, that of {}",
                        total.steps, total.split, left, seconds, s.speed, whoIs(s.speed, s.settings, s.bodies)),
            "give a smaller speed or acceleration, or shorter times (more frames_per_second); particles that lie in "
            "one another or in a solid, or a depth beyond reason, do this, too"};
    }
    return total;
}

void Solver::watchSteps(StepWatch watch) {
    state_->watch = std::move(watch);
}

DeviceParticles Solver::onDevice() const {
    const State& s = *state_;
    return {s.buffers[s.odd ? Slot::PositionOut : Slot::PositionIn].buffer(),
            s.buffers[s.odd ? Slot::VelocityOut : Slot::VelocityIn].buffer(),
            s.buffers[s.odd ? Slot::IdentityOut : Slot::IdentityIn].buffer(),
            s.counts.entries,
            s.counts.living,
            s.counts.next_identity,
            s.changing()};
}

void Solver::drive(std::size_t body, const Vector& centre, const std::array<double, 4>& turn, double seconds) {
    State& s = *state_;
    Drive& drive = s.settings.bodies.at(body).drive;
    BodyState& state = s.bodies.at(body);
    drive = driveFrom(state, centre, turn, s.time, seconds);
    // Before the first step, as the rule for its length asks.
    state.velocity = vk::times(1.0 / seconds, minus(drive.to, drive.from));
    state.spin = drive.spin;
    s.speed = std::max(s.speed, fastestPoint(s.settings.bodies, s.bodies));
}

Status Solver::setFlow(const FlowSettings& flow) {
    State& s = *state_;
    SimulationSettings changed = s.settings;
    apply(flow, changed);
    if (Status status = checkSettings(changed); !status) {
        return status;
    }
    if (!flow.fluids.empty()) {
        const std::vector<Fluid> water{Fluid{}};  // what settings without a list stand for
        if (Status status = checkChange(s.settings.fluids.empty() ? water : s.settings.fluids, flow.fluids); !status) {
            return status;
        }
        changed = withoutNeedlessFluids(changed);
    }
    if (!flow.emitters.empty() && !s.opened) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation: emitters", "it was begun without one",
                     "begin it with an emitter, and shut that"};
    }
    if (featuresOf(changed) != featuresOf(s.settings)) {
        Result<Kernels> kernels = Kernels::create(s.device, featuresOf(changed));
        if (!kernels) {
            return kernels.error();
        }
        s.kernels = std::move(kernels).value();
        if (s.buffers.particles > 0) {
            s.kernels.bind(s.buffers, s.meshes, s.seen_by);
        }
        s.depth = 0.0;  // along another axis it is not known
        s.measurable = false;
    }
    s.settings = std::move(changed);
    s.sources = sourceBlock(s.settings.sources);
    s.speed = std::max(s.speed, fastestJet(s.settings));
    return {};
}

std::uint32_t Solver::count() const {
    return state_->counts.living;
}

double Solver::time() const {
    return state_->time;
}

std::span<const BodyState> Solver::bodies() const {
    return state_->bodies;
}

Result<ParticleState> Solver::read() const {
    const State& s = *state_;
    Result<ParticleState> particles = downloadParticles(s.device, s.buffers, s.counts.entries, s.odd);
    if (particles && s.settings.fluids.empty()) {
        particles.value().fluid.clear();
    }
    return particles;
}

Result<std::vector<float>> Solver::densities() const {
    State& s = *state_;
    if (!s.measurable) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation", "densities are those of a step, and there was none",
                     "take a step first"};
    }
    const Status status = runOnce(s.device, [&s](VkCommandBuffer commands) {
        // In and Out have changed places since; this pass reads neither.
        s.kernels.dispatch(commands, Kernel::Measure, s.odd, groupsOf(s.moved, kGroup));
    });
    if (!status) {
        return status.error();
    }
    return downloadDensities(s.device, s.buffers, s.moved, s.odd);
}

Result<NeighbourLists> Solver::lists() const {
    const State& s = *state_;
    if (s.changing()) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "simulation", "lists are those of particles that stay", ""};
    }
    return downloadLists(s.device, s.buffers, s.counts.living, s.odd);
}

std::vector<std::pair<std::string, double>> Solver::times() const {
    return state_->timer.sums();
}

}  // namespace sluice::vk
