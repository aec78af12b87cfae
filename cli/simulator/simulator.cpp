// SPDX-License-Identifier: MIT
#include "simulator/simulator.hpp"

#include <algorithm>
#include <cmath>

#include "device/device.hpp"
#include "simulation/solver.hpp"
#include "simulation/time_step.hpp"

namespace sluice::simulator {
namespace {

vk::SimulationSettings settingsOf(const Setup& setup) {
    vk::SimulationSettings s;
    s.radius = setup.radius;
    s.low = setup.low;
    s.high = setup.high;
    s.gravity = setup.gravity;
    s.iterations = setup.iterations;
    s.kernel = setup.kernel == Kernel::Spline     ? vk::DensityKernel::Spline
               : setup.kernel == Kernel::Wendland ? vk::DensityKernel::Wendland
                                                  : vk::DensityKernel::Poly6;
    s.relaxation = setup.relaxation;
    s.tensile = setup.tensile;
    s.viscosity = setup.viscosity;
    s.vorticity = setup.vorticity;
    s.cfl = setup.cfl;
    s.tension = setup.tension;
    s.adhesion = setup.adhesion;
    s.overshoot = setup.overshoot;
    for (const Fluid& f : setup.fluids) {
        s.fluids.push_back({f.density, f.viscosity, f.tension, f.adhesion});
    }
    for (const Sphere& sphere : setup.spheres) {
        s.solids.push_back(vk::sphereSolid(sphere.centre, sphere.radius));
    }
    for (const Capsule& capsule : setup.capsules) {
        s.solids.push_back(vk::capsuleSolid(capsule.from, capsule.to, capsule.radius));
    }
    for (const Box& box : setup.boxes) {
        s.solids.push_back(vk::boxSolid(box.centre, box.half, box.turn_degrees));
    }
    for (const Plane& plane : setup.planes) {
        s.solids.push_back(vk::planeSolid(plane.normal, plane.through));
    }
    for (const Emitter& e : setup.emitters) {
        s.sources.emitters.push_back(
            {e.disc, e.centre, e.direction, e.width, e.height, e.speed, e.rate, e.start, e.stop, e.fluid});
    }
    for (const Drain& drain : setup.drains) {
        s.sources.drains.push_back({drain.sphere, drain.centre, drain.half});
    }
    for (const ForceField& f : setup.fields) {
        const vk::ForceKind kind = f.kind == ForceField::Kind::Wind    ? vk::ForceKind::Wind
                                   : f.kind == ForceField::Kind::Point ? vk::ForceKind::Point
                                                                       : vk::ForceKind::Vortex;
        s.sources.fields.push_back({kind, f.centre, f.axis, f.strength, f.radius});
    }
    for (const Body& b : setup.bodies) {
        vk::Body body{b.shape == Body::Shape::Sphere    ? vk::SolidKind::Sphere
                      : b.shape == Body::Shape::Capsule ? vk::SolidKind::Capsule
                                                        : vk::SolidKind::Box,
                      b.centre,
                      b.half,
                      b.turn_degrees,
                      b.density,
                      b.velocity,
                      b.spin};
        for (const PathPoint& point : b.path) {
            body.path.push_back({point.time, point.centre, point.turn_degrees});
        }
        s.bodies.push_back(std::move(body));
    }
    s.sources.most_particles = setup.most_particles;
    s.meshes = setup.meshes;
    s.seen = setup.seen;
    return s;
}

}  // namespace

Status check(const Setup& setup) {
    return vk::checkSettings(settingsOf(setup));
}

double fastestAllowed(const Setup& setup, double seconds) {
    const vk::SimulationSettings settings = settingsOf(setup);
    return vk::fastestOf(double{settings.cfl} * double{settings.support()}, seconds);
}

double fastestOfBody(const Setup& setup, std::size_t body) {
    const vk::Body made = settingsOf(setup).bodies.at(body);
    const vk::BodyState state = vk::startOf(made);
    return vk::fastestPoint({&made, 1}, {&state, 1});
}

Status addMeshes(Setup& setup, std::span<const Mesh> meshes) {
    std::vector<vk::Mesh> all;
    for (const Mesh& mesh : meshes) {
        all.push_back({mesh.name, mesh.corners, mesh.triangles});
    }
    Result<vk::DistanceGrid> grid = vk::distanceGrid(all, setup.radius, setup.low, setup.high);
    if (!grid) {
        return grid.error();
    }
    setup.meshes = std::make_shared<const vk::DistanceGrid>(std::move(grid).value());
    return {};
}

Result<std::shared_ptr<const vk::DepthField>> seenDepth(const SeenImage& image, const std::vector<float>& depth,
                                                        std::uint32_t scale, float thickness, float radius) {
    const vk::DepthView camera{image.view, image.projection, image.near_plane};
    if (const Status status = vk::checkDepthView(camera); !status) {
        return status.error();
    }
    auto field = std::make_shared<const vk::DepthField>(
        vk::depthField(camera, image.width, image.height, scale,
                       thickness > 0.0F ? thickness : vk::kThicknessInRadii * radius, depth));
    if (const Status status = vk::checkDepthField(*field, radius); !status) {
        return status.error();
    }
    return std::shared_ptr<const vk::DepthField>(std::move(field));
}

double mostParticles(const Setup& setup, std::size_t at_start, double seconds) {
    auto most = static_cast<double>(at_start);
    for (const vk::Emitter& emitter : settingsOf(setup).sources.emitters) {
        const std::size_t sites = vk::outletSites(emitter, setup.radius).size();
        const double open = std::max(seconds - double{emitter.start}, 0.0);
        // A layer more for that of the very start, and one for what rounding may make of the last.
        const double layers = std::floor(open / vk::layerPeriod(emitter, sites, setup.radius)) + 2.0;
        most += layers * static_cast<double>(sites);
    }
    return most;
}

std::vector<double> clearances(const Setup& setup, const std::vector<float>& positions) {
    const vk::SimulationSettings settings = settingsOf(setup);
    std::vector<double> all;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const Vec3 x{positions[i], positions[i + 1], positions[i + 2]};
        double nearest = 1e300;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            nearest = std::min({nearest, double{x.at(axis)} - double{setup.low.at(axis)},
                                double{setup.high.at(axis)} - double{x.at(axis)}});
        }
        for (const vk::Solid& solid : settings.solids) {
            nearest = std::min(nearest, vk::distanceTo(solid, x));
        }
        if (settings.meshed()) {
            nearest = std::min(nearest, vk::contactWith(*settings.meshes, vk::wide(x)).distance);
        }
        for (const vk::Body& body : settings.bodies) {
            nearest = std::min(nearest, vk::distanceTo(vk::solidOf(body, vk::startOf(body)), x));
        }
        all.push_back(nearest);
    }
    return all;
}

struct Simulator::State {
    std::unique_ptr<vk::Device> device;
    std::unique_ptr<vk::Solver> solver;  // dies before its device
};

Simulator::Simulator(std::unique_ptr<State> state) : state_(std::move(state)) {}
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;
Simulator::~Simulator() = default;

Result<Simulator> Simulator::create(const Setup& setup, bool validation) {
    const vk::SimulationSettings settings = settingsOf(setup);
    if (const Status status = vk::checkSettings(settings); !status) {
        return status.error();
    }
    auto state = std::make_unique<State>();
    vk::DeviceRequest request;
    request.match_host = false;  // nothing is shared with OpenGL
    request.validation = validation;
    auto device = vk::Device::create(request);
    if (!device) {
        return device.error();
    }
    state->device = std::move(device).value();
    auto solver = vk::Solver::create(*state->device, settings);
    if (!solver) {
        return solver.error();
    }
    state->solver = std::move(solver).value();
    return Simulator(std::move(state));
}

Status Simulator::setDepth(const vk::DepthField& seen) {
    return state_->solver->setDepthField(seen);
}

Status Simulator::setParticles(const Particles& particles) {
    return state_->solver->setParticles(particles.position, particles.velocity, particles.fluid);
}

Result<Advance> Simulator::advance(double seconds, double longest, const std::function<bool()>& stop) {
    bool stopped = false;
    state_->solver->watchSteps([&](const vk::StepReport& /*step*/, bool /*kept*/) {
        stopped = stop();
        return !stopped;
    });
    const Result<vk::AdvanceReport> report = state_->solver->advance(seconds, longest);
    state_->solver->watchSteps({});
    if (!report) {
        return report.error();
    }
    const vk::AdvanceReport& r = report.value();
    Advance out{r.steps, r.split,   r.shortest, r.speed, r.most_neighbours, 0.0, 0.0,
                r.born,  r.blocked, r.drained,  stopped};
    if (stopped) {
        return out;
    }
    const Result<std::vector<float>> densities = state_->solver->densities();
    if (!densities) {
        return densities.error();
    }
    for (const float density : densities.value()) {
        out.mean_compression += std::max(double{density} - 1.0, 0.0);
        out.greatest_density = std::max(out.greatest_density, double{density});
    }
    out.mean_compression /= static_cast<double>(std::max<std::size_t>(densities.value().size(), 1));
    return out;
}

Result<Particles> Simulator::read() const {
    Result<vk::ParticleState> state = state_->solver->read();
    if (!state) {
        return state.error();
    }
    return Particles{std::move(state.value().position), std::move(state.value().velocity),
                     std::move(state.value().fluid)};
}

std::vector<BodyPose> Simulator::bodies() const {
    std::vector<BodyPose> poses;
    for (const vk::BodyState& state : state_->solver->bodies()) {
        BodyPose pose{vk::narrow(state.centre),   {},
                      vk::narrow(state.velocity), vk::narrow(state.spin),
                      vk::narrow(state.force),    vk::narrow(state.torque)};
        std::transform(state.turn.begin(), state.turn.end(), pose.turn.begin(),
                       [](double part) { return static_cast<float>(part); });
        poses.push_back(pose);
    }
    return poses;
}

std::string Simulator::device() const {
    return state_->device->properties.deviceName;
}

std::uint32_t Simulator::validationMessages() const {
    return state_->device->validationMessages();
}

std::vector<std::pair<std::string, double>> Simulator::times() const {
    return state_->solver->times();
}

}  // namespace sluice::simulator
