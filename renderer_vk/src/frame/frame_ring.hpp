// SPDX-License-Identifier: MIT
// Frames in flight: one slot per image set, each with its commands, its timestamps and what it must keep alive.
#pragma once

#include <volk.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "device/device.hpp"
#include "frame/frame_timer.hpp"
#include "frame/particle_store.hpp"
#include "frame/shared_images.hpp"
#include "frame/tracer.hpp"
#include "live/live_simulation.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sync/renderer_timeline.hpp"

namespace sluice::vk {

/// Records the passes of a frame between its acquire and its release.
using PassRecorder = std::function<Status(VkCommandBuffer, const ParticleBuffers&, PassTimer&)>;

/// What a frame draws: particles that the host gave, or those of a simulation.
struct FrameFluid {
    std::shared_ptr<ParticleSet> particles;
    SimulatedFluid simulated;  ///< of value 0: none
};

/// Used on the renderer's thread. Dies after drain(), before the timeline and the images.
class FrameRing {
  public:
    /// How long a slot waits for its previous frame before the frame is given up.
    static constexpr std::uint64_t kPatienceNs = 10'000'000'000;

    static Result<std::unique_ptr<FrameRing>> create(const Device& device, RendererTimeline& timeline,
                                                     const Tracer& tracer, std::uint32_t slots);

    FrameRing(const Device& device, RendererTimeline& timeline, const Tracer& tracer, std::uint32_t slots);
    FrameRing(const FrameRing&) = delete;
    FrameRing& operator=(const FrameRing&) = delete;
    ~FrameRing();

    /// Waits until the slot of `image_set` is free; fails after kPatienceNs.
    [[nodiscard]] Status waitForSlot(std::uint32_t image_set);
    /// Waits until no frame is running; fails after kPatienceNs.
    [[nodiscard]] Status waitForAll();

    /// Records and submits; waitForSlot has succeeded. `frame` has been checked against the protocol.
    [[nodiscard]] Status submit(const SluiceFrame& frame, const SharedImages& images, const FrameFluid& fluid,
                                const PassRecorder& record);

    /// Fills everything but struct_size and validation_messages. NOT_READY while it runs, INVALID_ARGUMENT if the frame
    /// is not among the last ones.
    [[nodiscard]] SluiceResult poll(std::uint64_t frame, SluiceFrameStats& stats);

    /// Collects every finished frame, so that its events reach the trace.
    void collect();

  private:
    struct Slot {
        explicit Slot(const Device& device) : timer(device) {}
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        FrameTimer timer;
        std::shared_ptr<ParticleSet> particles;
        bool running = false;
        bool uploads = false;            ///< this frame copies the particles from staging
        std::uint64_t submitted_ns = 0;  ///< for devices without timestamps
        std::uint64_t wait_value = 0;    ///< 0: waited for nothing
        SimulatedFluid simulated;        ///< of value 0: none
        std::uint64_t cpu_bytes_before = 0;
        std::vector<std::uint64_t> image_bytes;  ///< of each shared image, for its acquire and release
        SluiceFrameStats stats{};
    };

    [[nodiscard]] Status createSlot(Slot& slot) const;
    [[nodiscard]] Status record(Slot& slot, const SluiceFrame& frame, const SharedImages& images,
                                const PassRecorder& record) const;
    [[nodiscard]] Status enqueue(Slot& slot, const SluiceFrame& frame, const SubmitSemaphores& semaphores) const;
    [[nodiscard]] bool finished(const Slot& slot) const;
    void finish(Slot& slot);
    void finishOne(Slot& slot);
    void emit(const Slot& slot, const FrameTimes& times) const;

    const Device& device_;
    RendererTimeline& timeline_;
    Tracer tracer_;
    std::vector<std::unique_ptr<Slot>> slots_;
};

}  // namespace sluice::vk
