// SPDX-License-Identifier: MIT
#include "simulation/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "simulation/kernels.hpp"
#include "simulation/step_timer.hpp"
#include "simulation/time_step.hpp"
#include "simulation/transfer.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kNotFinite = 1;  // FAULT_ of simulation.glsl
constexpr std::uint32_t kCrowded = 2;
/// Rows of the lists to begin with; at rest a particle has 32 neighbours.
constexpr std::uint32_t kFirstNeighbours = 64;
/// Supports. Farther, and the particles that the lists were made for are no neighbours any more.
constexpr double kFarthestMove = 1.0;
/// Of one call of advance: what needs more is not going to end.
constexpr std::uint32_t kMostSteps = 4096;
constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kScanGroup = 8;

std::uint32_t groupsOf(std::uint32_t items, std::uint32_t group) {
    return (items + group - 1) / group;
}

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

}  // namespace

struct Solver::State {
    State(const Device& on, SimulationSettings with) : device(on), settings(std::move(with)), timer(on) {}

    const Device& device;
    SimulationSettings settings;
    Grid grid;
    Kernels kernels;
    SimulationBuffers buffers;
    StepTimer timer;
    std::uint32_t count = 0;
    bool odd = false;         ///< In and Out have changed places
    bool measurable = false;  ///< the sorted buffers are those of the state
    double speed = 0.0;       ///< m/s, of the fastest particle

    [[nodiscard]] Slot in(Slot even, Slot when_odd) const { return odd ? when_odd : even; }
    void run(VkCommandBuffer commands, Kernel kernel, std::uint32_t groups);
    void record(VkCommandBuffer commands);
    [[nodiscard]] Result<StepStatus> tryStep(float dt);
    [[nodiscard]] Status makeRoom(std::uint32_t particles);
    [[nodiscard]] Result<StepReport> attempt(double seconds);
    void keep(const StepReport& report);
};

void Solver::State::run(VkCommandBuffer commands, Kernel kernel, std::uint32_t groups) {
    kernels.dispatch(commands, kernel, odd, groups);
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                      VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
    timer.mark(commands, kernelName(kernel));
}

void Solver::State::record(VkCommandBuffer commands) {
    const std::uint32_t all = groupsOf(count, kGroup);
    const std::uint32_t blocks = groupsOf(groupsOf(grid.cells(), kScanBlock), kScanGroup);
    timer.begin(commands);
    device.fn.vkCmdFillBuffer(commands, buffers[Slot::Cells].buffer(), 0, VK_WHOLE_SIZE, 0);
    device.fn.vkCmdFillBuffer(commands, buffers[Slot::Status].buffer(), 0, VK_WHOLE_SIZE, 0);
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    timer.mark(commands, "clear");
    run(commands, Kernel::Predict, all);
    run(commands, Kernel::ScanSums, blocks);
    run(commands, Kernel::ScanBlocks, 1);
    run(commands, Kernel::ScanCells, blocks);
    run(commands, Kernel::Scatter, all);
    run(commands, Kernel::Order, all);
    run(commands, Kernel::Neighbours, all);
    for (std::uint32_t i = 0; i < settings.iterations; ++i) {
        run(commands, Kernel::Lambda, all);
        run(commands, Kernel::Delta, all);
    }
    run(commands, Kernel::Velocity, all);
    const bool confined = settings.vorticity > 0.0F;
    if (confined) {
        run(commands, Kernel::Curl, all);
    }
    run(commands, confined ? Kernel::FinishConfined : Kernel::Finish, all);
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
    const VkBufferCopy whole{0, 0, sizeof(StepStatus)};
    device.fn.vkCmdCopyBuffer(commands, buffers[Slot::Status].buffer(), buffers.read_back.buffer(), 1, &whole);
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

Result<StepStatus> Solver::State::tryStep(float dt) {
    const Parameters parameters = parametersOf(settings, grid, count, buffers.stride(), buffers.neighbours, dt);
    std::memcpy(buffers[Slot::Parameters].mapped().data(), &parameters, sizeof parameters);
    // The host decides after every step whether it counts, so there is never more than one under way.
    if (const Status status = runOnce(device, [this](VkCommandBuffer commands) { record(commands); }); !status) {
        return status.error();
    }
    timer.collect();
    StepStatus status{};
    std::memcpy(&status, buffers.read_back.mapped().data(), sizeof status);
    return status;
}

Result<StepReport> Solver::State::attempt(double seconds) {
    measurable = false;
    for (;;) {
        const Result<StepStatus> tried = tryStep(static_cast<float>(seconds));
        if (!tried) {
            return tried.error();
        }
        const StepStatus& status = tried.value();
        if ((status.faults & kNotFinite) != 0) {
            return Error{SLUICE_ERROR_INTERNAL, "simulation",
                         fmt::format("a position or velocity became NaN or infinite in a step of {} s", seconds),
                         "the state is that before the step; take smaller velocities or forces"};
        }
        if ((status.faults & kCrowded) != 0) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
                         "more than 60000 particles lie within two supports of one place",
                         "the state is that before the step; spread the particles, or make their radius smaller"};
        }
        if (status.most_neighbours <= buffers.neighbours) {
            return StepReport{seconds, double{std::bit_cast<float>(status.speed_bits)},
                              double{std::bit_cast<float>(status.move_bits)}, status.most_neighbours};
        }
        // The lists were cut short, so nothing of this step counts. A quarter of room, so that it does not happen at
        // every step of a fluid that is being pressed together.
        const std::uint32_t rows = (status.most_neighbours + status.most_neighbours / 4 + 15) / 16 * 16;
        device.log(SLUICE_LOG_INFO,
                   fmt::format("simulation: lists of {} neighbours were too short, now {}", buffers.neighbours, rows));
        if (const Status grown = growLists(device, buffers, rows); !grown) {
            return grown.error();
        }
        kernels.bind(buffers);
    }
}

void Solver::State::keep(const StepReport& report) {
    odd = !odd;
    measurable = true;
    speed = report.speed;
}

Status Solver::State::makeRoom(std::uint32_t particles) {
    const Grid planned = planGrid(settings, particles);
    if (particles > buffers.particles || planned.cells() > buffers.cells) {
        Result<SimulationBuffers> made =
            createBuffers(device, std::max(particles, buffers.particles),
                          std::max(kFirstNeighbours, buffers.neighbours), std::max(planned.cells(), buffers.cells));
        if (!made) {
            return made.error();
        }
        buffers = std::move(made).value();
        kernels.bind(buffers);
    }
    grid = planned;
    return {};
}

Solver::Solver(std::unique_ptr<State> state) : state_(std::move(state)) {}
Solver::~Solver() = default;

Result<std::unique_ptr<Solver>> Solver::create(const Device& device, const SimulationSettings& settings) {
    if (const Status status = checkSettings(settings); !status) {
        return status.error();
    }
    auto state = std::make_unique<State>(device, settings);
    state->settings.solids = solidsWithin(settings);
    Result<Kernels> kernels = Kernels::create(device);
    if (!kernels) {
        return kernels.error();
    }
    state->kernels = std::move(kernels).value();
    return std::unique_ptr<Solver>(new Solver(std::move(state)));
}

Status Solver::setParticles(std::span<const float> positions, std::span<const float> velocities) {
    State& s = *state_;
    if (Status status = checkParticles(s.settings, positions, velocities); !status) {
        return status;
    }
    const auto count = static_cast<std::uint32_t>(positions.size() / 3);
    if (Status status = s.makeRoom(count); !status) {
        return status;
    }
    s.odd = false;
    s.measurable = false;
    s.count = count;
    s.speed = fastest(velocities);
    return uploadParticles(s.device, s.buffers, positions, velocities);
}

Result<StepReport> Solver::step(double seconds) {
    if (state_->count == 0 || !(seconds > 0.0 && seconds <= 1.0)) {
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
    if (s.count == 0 || !(seconds > 0.0 && longest > 0.0 && longest <= 1.0)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
                     fmt::format("expected particles, a time > 0 and steps in (0, 1] s, found {}, {} and {}", count(),
                                 seconds, longest),
                     ""};
    }
    const auto h = double{s.settings.support()};
    const StepLimits limits{longest, double{s.settings.cfl} * h, norm(s.settings.gravity)};
    AdvanceReport total;
    total.shortest = longest;
    double left = seconds;
    double most = seconds;  // halved when a step went too far, until the next one that did not
    while (left > 0.0 && total.steps + total.split < kMostSteps) {
        const double wanted = nextStep(left, s.speed, limits);
        if (left / wanted > kMostSteps) {
            break;
        }
        const double dt = std::min(wanted, most);
        const Result<StepReport> report = s.attempt(dt);
        if (!report) {
            return report.error();
        }
        total.most_neighbours = std::max(total.most_neighbours, report.value().most_neighbours);
        if (report.value().move > kFarthestMove * h) {
            ++total.split;
            most = dt / 2.0;
            if (most < longest / 1024.0) {
                break;
            }
            continue;
        }
        s.keep(report.value());
        ++total.steps;
        total.shortest = std::min(total.shortest, dt);
        total.speed = std::max(total.speed, s.speed);
        left = dt < left * (1.0 - 1e-9) ? left - dt : 0.0;
        most = seconds;
    }
    if (left > 0.0) {
        return Error{
            SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
            fmt::format("no step was stable: after {} steps and {} halvings, {} s of {} are left at a speed of "
                        "{:.3g} m/s",
                        total.steps, total.split, left, seconds, s.speed),
            "particles that lie in one another or in a solid, or a speed beyond reason, do this"};
    }
    return total;
}

std::uint32_t Solver::count() const {
    return state_->count;
}

Result<ParticleState> Solver::read() const {
    const State& s = *state_;
    return downloadParticles(s.device, s.buffers, s.count, s.odd);
}

Result<std::vector<float>> Solver::densities() const {
    State& s = *state_;
    if (!s.measurable) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation", "densities are those of a step, and there was none",
                     "take a step first"};
    }
    const Status status = runOnce(s.device, [&s](VkCommandBuffer commands) {
        // In and Out have changed places since; this pass reads neither.
        s.kernels.dispatch(commands, Kernel::Measure, s.odd, groupsOf(s.count, kGroup));
    });
    if (!status) {
        return status.error();
    }
    return downloadDensities(s.device, s.buffers, s.count, s.odd);
}

Result<NeighbourLists> Solver::lists() const {
    const State& s = *state_;
    return downloadLists(s.device, s.buffers, s.count, s.odd);
}

std::vector<std::pair<std::string, double>> Solver::times() const {
    return state_->timer.sums();
}

}  // namespace sluice::vk
