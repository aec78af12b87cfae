// SPDX-License-Identifier: MIT
// Position-based fluid on the device (Macklin & Mueller 2013). docs/simulation.md has the passes and their formulas.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "device/device.hpp"
#include "simulation/anisotropy.hpp"
#include "simulation/settings.hpp"
#include "simulation/whitewater.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Particles in the order in which they were given. Triples are packed.
struct ParticleState {
    std::vector<float> position, velocity;
    std::vector<std::uint32_t> fluid;  ///< of each, where the settings have fluids; else empty
};

/// What one step did, or tried to do.
struct StepReport {
    double seconds = 0.0;  ///< its length
    double speed = 0.0;    ///< fastest particle after it, m/s
    double move = 0.0;     ///< farthest that a particle went, m
    std::uint32_t most_neighbours = 0;
    std::uint32_t born = 0,
                  blocked = 0;  ///< of those that were to be born, and could not because of what was in the way
    std::uint32_t drained = 0;
    double depth = 0.0;  ///< of the deepest fluid, m, where steps are held to it; else 0
};
/// What it took to get from one time to another.
struct AdvanceReport {
    std::uint32_t steps = 0;
    std::uint32_t split = 0;  ///< steps that were taken again shorter: something flew too far, or the fluid is too deep
    double shortest = 0.0;    ///< step, seconds
    double speed = 0.0;       ///< greatest of all steps, m/s
    std::uint32_t most_neighbours = 0;
    std::uint64_t born = 0, blocked = 0, drained = 0;  ///< particles
};

/// `kept`: false for a step that is taken again, shorter. On false advance() ends.
using StepWatch = std::function<bool(const StepReport&, bool kept)>;

/// The state as it lies on the device, in the solver's own order; `identity` says whose each entry is.
struct DeviceParticles {
    VkBuffer position = VK_NULL_HANDLE,
             velocity = VK_NULL_HANDLE;  ///< four floats each; a velocity's last is its fluid
    VkBuffer identity = VK_NULL_HANDLE;
    std::uint32_t count = 0;       ///< of entries
    std::uint32_t living = 0;      ///< those whose fourth number of position is 0
    std::uint32_t identities = 0;  ///< every identity is below; as many as entries where nobody comes or goes
    bool changing = false;         ///< somebody may
};

/// Where each identity has its place when particles come and go: shaders/common/places.glsl. None: the identity is the
/// place.
struct PlaceBuffers {
    VkBuffer marks = VK_NULL_HANDLE, before = VK_NULL_HANDLE;
    [[nodiscard]] explicit operator bool() const { return marks != VK_NULL_HANDLE; }
};

/// Every neighbour list, for tests: `list[i]` holds the identities of the neighbours of the particle with identity i.
struct NeighbourLists {
    std::vector<std::vector<std::uint32_t>> list;
    std::vector<float> position;  ///< predicted, by identity: what the lists were made from
};

/// Owns its buffers on a device that must outlive it. Each call waits for the device: calls are made from one thread.
/// The same device, settings, particles and calls give the same bits.
class Solver {
  public:
    static Result<std::unique_ptr<Solver>> create(const Device& device, const SimulationSettings& settings);
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;
    ~Solver();

    /// Replaces all particles and sets the time to 0; velocities are 0 if there are none. There may be no particles if
    /// there is an emitter. Refused, with the particle named, if one is not
    /// finite, outside the domain or in a solid; the particles before then stay. `fluids`: which of the settings' each
    /// is; of the first if there are none.
    [[nodiscard]] Status setParticles(std::span<const float> positions, std::span<const float> velocities,
                                      std::span<const std::uint32_t> fluids = {});
    /// What is seen from now on, in place of SimulationSettings::seen, which there must have been. On an error it stays
    /// as it was.
    [[nodiscard]] Status setDepthField(const DepthField& field);
    /// The same from a buffer on the device, a DepthHeader and its depths, that must last until there is another; what
    /// wrote it has ended.
    void useDepthField(VkBuffer field);
    /// One step of that length, whatever the CFL number. On an error the state is that before the step.
    [[nodiscard]] Result<StepReport> step(double seconds);
    /// As many steps as the CFL rule asks for, none longer than `longest`. An error says why it could not be done; the
    /// state is then that of the last good step. One that its watch ends returns what was done until then.
    [[nodiscard]] Result<AdvanceReport> advance(double seconds, double longest);

    /// Called after each step that advance() has tried, on its thread.
    void watchSteps(StepWatch watch);

    [[nodiscard]] std::uint32_t count() const;
    /// Until the next call that changes the state. Its last writes are those of a compute shader.
    [[nodiscard]] DeviceParticles onDevice() const;
    /// The ellipsoid of each particle, out of the lists of the last step (or of a search of their own where there was
    /// none), into `to`: kEllipsoidFloats each, in the place that `places` say, or its identity.
    [[nodiscard]] Status ellipsoids(const Anisotropy& how, VkBuffer to, const PlaceBuffers& places = {});
    /// Where the last step's water turns white, likewise: kWhitewaterFloats each. 0 before any step.
    [[nodiscard]] Status whitewater(const Whitewater& how, VkBuffer to, const PlaceBuffers& places = {});
    /// Seconds that were simulated since setParticles.
    [[nodiscard]] double time() const;
    /// Those that live, in the order in which they were given; then the others in the order of their birth.
    [[nodiscard]] Result<ParticleState> read() const;
    /// Sends a driven body straight on to another place, where it is after `seconds` > 0 more of simulated time.
    void drive(std::size_t body, const Vector& centre, const std::array<double, 4>& turn, double seconds);
    /// For the steps to come. Emitters only if there was one at the start. Refused, all stays as it was.
    [[nodiscard]] Status setFlow(const FlowSettings& flow);
    /// Bodies in the order of the settings, after the last step: pose, motion, and what the fluid did to them in it.
    [[nodiscard]] std::span<const BodyState> bodies() const;
    /// Density of each particle that the last step moved, in densities of rest; walls count as fluid at rest. Who was
    /// born at its end has none yet, and who was drained had one.
    [[nodiscard]] Result<std::vector<float>> densities() const;
    /// Refused with emitters or drains.
    [[nodiscard]] Result<NeighbourLists> lists() const;
    /// Milliseconds of each pass since the start, in order of first use; empty where the device has no timestamps.
    [[nodiscard]] std::vector<std::pair<std::string, double>> times() const;

  private:
    struct State;
    explicit Solver(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sluice::vk
