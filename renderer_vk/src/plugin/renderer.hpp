// SPDX-License-Identifier: MIT
// The renderer behind the C ABI: Results in, Results out. entry.cpp translates.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "device/device.hpp"
#include "frame/frame_ring.hpp"
#include "frame/particle_store.hpp"
#include "frame/shared_images.hpp"
#include "live/live_simulation.hpp"
#include "passes/fluid_recorder.hpp"
#include "plan/plan.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sync/renderer_timeline.hpp"

/// Opaque to the host. Members are declared so that they die in the right order: users before what they use.
struct SluiceRenderer {
  public:
    static sluice::Result<std::unique_ptr<SluiceRenderer>> create(const SluiceHostServices& host,
                                                                  const SluiceCreateInfo& info);

    SluiceRenderer() = default;
    SluiceRenderer(const SluiceRenderer&) = delete;
    SluiceRenderer& operator=(const SluiceRenderer&) = delete;
    ~SluiceRenderer() = default;

    [[nodiscard]] sluice::Status resize(std::uint32_t width, std::uint32_t height);
    [[nodiscard]] sluice::Status setParticles(const SluiceParticles& particles);
    [[nodiscard]] sluice::Status setEnvironment(const SluiceEnvironment* environment);
    /// Null ends the simulation.
    [[nodiscard]] sluice::Status setSimulation(const sluice::vk::LiveSetup* setup);
    [[nodiscard]] sluice::Status simulate(std::uint64_t value, double seconds);
    [[nodiscard]] sluice::Status setBody(const sluice::vk::BodyTarget& target);
    [[nodiscard]] sluice::Status setFlow(const sluice::vk::FlowSettings& flow);
    [[nodiscard]] sluice::Status resetSimulation(sluice::vk::LiveStart start);
    /// Null without one.
    [[nodiscard]] const sluice::vk::LiveSimulation* simulation() const { return simulation_.get(); }
    [[nodiscard]] const sluice::vk::Device& device() const { return *device_; }
    /// Everything about the frame is checked here.
    [[nodiscard]] sluice::Status submitFrame(const SluiceFrame& frame);
    [[nodiscard]] SluiceResult poll(std::uint64_t frame, SluiceFrameStats& stats);
    [[nodiscard]] sluice::vk::RendererTimeline& timeline() { return *timeline_; }
    [[nodiscard]] const SluiceRendererInfo& info() const { return info_; }

    /// Waits for the device and frees everything. If the queue cannot be brought to an end, which only a binary
    /// semaphore that OpenGL never signals can cause, the device is left as it is: better a leak than a hang.
    static void destroy(std::unique_ptr<SluiceRenderer> renderer);

  private:
    [[nodiscard]] sluice::Status createImages(std::uint32_t width, std::uint32_t height);
    [[nodiscard]] sluice::Status quiesce();
    [[nodiscard]] sluice::Status preparePlan(const SluiceFrame& frame);
    [[nodiscard]] sluice::Result<sluice::vk::FrameFluid> fluidOf(const SluiceFrame& frame);
    [[nodiscard]] sluice::Status recordAndSubmit(const SluiceFrame& frame);

    SluiceHostServices host_{};  ///< a copy, so that a shorter table of an older host has its end as NULL
    std::unique_ptr<sluice::vk::Device> device_;
    std::unique_ptr<sluice::vk::RendererTimeline> timeline_;
    std::optional<sluice::vk::FluidRecorder> recorder_;
    std::unique_ptr<sluice::vk::SharedImages> images_;  ///< null after a failed resize
    /// Retired by a resize that could not wait for the frames that use them.
    std::vector<std::unique_ptr<sluice::vk::SharedImages>> abandoned_;
    std::shared_ptr<sluice::vk::ParticleSet> particles_;
    std::unique_ptr<sluice::vk::LiveSimulation> simulation_;
    /// Ended while frames that did not end might read it.
    std::unique_ptr<sluice::vk::LiveSimulation> ended_;
    std::unique_ptr<sluice::vk::FrameRing> frames_;
    std::optional<sluice::vk::Plan> plan_;  ///< the recorder's
    bool has_environment_ = false;
    std::uint32_t outputs_ = 0;
    std::uint64_t submitted_ = 0;
    std::uint64_t attempted_ = 0;
    SluiceRendererInfo info_{};
};
