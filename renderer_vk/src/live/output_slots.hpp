// SPDX-License-Identifier: MIT
// Where the simulation leaves its fluid for the frames: a ring of buffers on the device, and the pass that fills one.
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "frame/pass_context.hpp"
#include "live/foam_age.hpp"
#include "live/particle_places.hpp"
#include "memory/buffer.hpp"
#include "passes/pipeline.hpp"
#include "simulation/solver.hpp"

namespace sluice::vk {

/// Packed float triples, in the order in which the particles were given or born, without those that are gone: `draw`, a
/// VkDrawIndirectCommand, has their number. What else frames read of a particle gets a buffer here;
/// shaders/common/places.glsl says where a particle lies in it.
struct OutputSlot {
    Buffer position, velocity, draw;
    Buffer ellipsoids;  ///< kEllipsoidFloats each, if they were asked for
    Buffer whitewater;  ///< kWhitewaterFloats each, likewise; the last is the particle's foam
    Buffer fluids;      ///< a number each, of several fluids
};

/// Foam that is asked for.
struct FoamSettings {
    Whitewater ranges;
    double life = 1.0;  ///< s after which half is left
};

/// Value v lies in slot v mod count(). Filled by the simulation's thread, read by frames. Pinned; dies before `device`,
/// when no submitted work uses it.
class OutputSlots {
  public:
    /// `device`: that of the solver, a computeView(). `particles`: the most that there will ever be, at least 1.
    static Result<std::unique_ptr<OutputSlots>> create(const Device& device, std::uint32_t slots,
                                                       std::uint32_t particles, float radius,
                                                       const std::optional<Anisotropy>& anisotropy,
                                                       const std::optional<FoamSettings>& foam, bool several_fluids);
    explicit OutputSlots(const Device& device) : device_(device) {}
    OutputSlots(const OutputSlots&) = delete;
    OutputSlots& operator=(const OutputSlots&) = delete;
    ~OutputSlots();

    /// The shapes and the foam of the particles of `solver` into the slot of `value`, if they were asked for; returns
    /// when the device has done it. Before publish.
    [[nodiscard]] Status look(Solver& solver, std::uint64_t value);
    /// The particles are others from now on, whatever the solver's time.
    void forgetFoam();
    /// Copies `state` into the slot of `value`, signals, and returns when the device has done it. No work under way may
    /// use that slot.
    [[nodiscard]] Status publish(const DeviceParticles& state, std::uint64_t value,
                                 const VkSemaphoreSubmitInfo& signal);
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(slots_.size()); }
    /// `count` says only how many there are at most.
    [[nodiscard]] ParticleBuffers buffers(std::uint64_t value) const;
    [[nodiscard]] const OutputSlot& slot(std::uint64_t value) const { return slots_[value % slots_.size()]; }

  private:
    [[nodiscard]] Status whiten(Solver& solver, std::uint64_t value, const PlaceBuffers& places);

    const Device& device_;
    std::uint32_t particles_ = 0;
    float radius_ = 0.0F;
    std::optional<Anisotropy> anisotropy_;
    std::optional<FoamSettings> foam_;
    std::unique_ptr<FoamAge> foam_age_;
    double foam_time_ = 0.0;  ///< s, of the solver when the foam was aged last
    std::vector<OutputSlot> slots_;
    std::unique_ptr<ParticlePlaces> places_;
    Pipeline pipeline_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace sluice::vk
