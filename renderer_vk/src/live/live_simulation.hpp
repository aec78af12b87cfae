// SPDX-License-Identifier: MIT
// A fluid that flows on a thread of the renderer's while the host thinks, and what frames wait for to draw it.
#pragma once

#include <volk.h>

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "device/device.hpp"
#include "frame/pass_context.hpp"
#include "frame/tracer.hpp"
#include "live/body_reports.hpp"
#include "live/output_slots.hpp"
#include "live/seen_depths.hpp"
#include "simulation/solver.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sync/renderer_timeline.hpp"

namespace sluice::vk {

/// What `call` answers where there is none.
[[nodiscard]] Error noSimulation(const char* call);

/// What flows, and how.
struct LiveSetup {
    SimulationSettings settings;
    std::vector<float> position, velocity;  ///< triples; velocity may be empty
    std::vector<std::uint32_t> fluid;       ///< of each particle, of settings.fluids; may be empty
    double longest_step = 1.0;
    std::uint32_t frames_in_flight = 1;
    std::uint32_t most_particles = 0;  ///< that there will ever be; room of the output slots
    std::optional<Anisotropy> anisotropy;
    std::optional<FoamSettings> foam;
    std::uint32_t depth_scale = 0;  ///< as SluiceSimulation has it; not 0: with settings.seen
    std::uint32_t depth_lag = 1;
    float depth_thickness = 0.0F;  ///< m
};

/// What it begins with anew.
struct LiveStart {
    std::vector<float> position, velocity;  ///< as LiveSetup has them
    std::vector<std::uint32_t> fluid;       ///< likewise
};

/// Where a driven body is to be.
struct BodyTarget {
    std::uint32_t body = 0;
    Vector centre{};
    std::array<double, 4> turn{};  ///< of any length but 0
};

/// The fluid of one value, for one frame.
struct SimulatedFluid {
    ParticleBuffers particles;
    std::uint64_t value = 0;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    bool waits = true;  ///< false: a fault of tests
    /// What the frame captures its depth into; none: it does not.
    DepthRoom captured{};
};

/// The solver looks at every step's outcome before the next one, so it needs a thread; that thread is the only one that
/// uses the solver. Value v waits for the frames that drew value v - slots, which nobody may draw any more once v has
/// been asked for. Pinned; device and timeline must outlive it. simulate(), setBody(), setFlow(), reset(), fluid() and
/// drawn() on the renderer's thread.
class LiveSimulation {
  public:
    static Result<std::unique_ptr<LiveSimulation>> create(const Device& device, const RendererTimeline& timeline,
                                                          const Tracer& tracer, const LiveSetup& setup);
    LiveSimulation(const RendererTimeline& timeline, const Tracer& tracer, std::unique_ptr<Device> device,
                   const LiveSetup& setup);
    LiveSimulation(const LiveSimulation&) = delete;
    LiveSimulation& operator=(const LiveSimulation&) = delete;
    /// No submitted frame may use the slots any more. Waits for the step under way.
    ~LiveSimulation();

    [[nodiscard]] Status simulate(std::uint64_t value, double seconds);
    /// At the end of the value that simulate() is called with next.
    [[nodiscard]] Status setBody(const BodyTarget& target);
    /// From that value on.
    [[nodiscard]] Status setFlow(const FlowSettings& flow);
    /// What that value begins with. live_reset.cpp has it.
    [[nodiscard]] Status reset(LiveStart start);
    /// Refused if `value` was not asked for or its slot may be overwritten. Where the device has one queue this waits
    /// until the last work of `value` has been submitted: behind a frame that waits for it, it would never run. Fails
    /// after FrameRing::kPatienceNs.
    [[nodiscard]] Result<SimulatedFluid> fluid(std::uint64_t value, bool skip_wait);
    /// Where the first frame that draws `value` captures its depth, in so many bytes of `device`; none for another, and
    /// where the fluid does not collide with it.
    [[nodiscard]] Result<DepthRoom> captureRoom(const Device& device, std::uint64_t value, VkDeviceSize bytes);
    [[nodiscard]] std::uint32_t depthScale() const { return depth_scale_; }
    [[nodiscard]] float depthThickness() const { return depth_thickness_; }
    /// A frame that signals `signal_value` of the renderer's timeline draws `value`, and has captured into that.
    void drawn(std::uint64_t value, std::uint64_t signal_value, const std::shared_ptr<const DepthBuffer>& captured);
    /// The most that there will ever be.
    [[nodiscard]] std::uint32_t particles() const { return most_particles_; }
    /// Where the values lie; what a slot holds is to be looked at while no later value may be written into it.
    [[nodiscard]] const OutputSlots& slots() const { return *slots_; }
    /// Its particles are ellipsoids.
    [[nodiscard]] bool shaped() const { return shaped_; }
    /// They carry foam.
    [[nodiscard]] bool foams() const { return foams_; }
    /// They are of several fluids.
    [[nodiscard]] bool mixed() const { return mixed_; }

    /// No more values: the thread ends after the step under way, and every value that was asked for is signalled, so
    /// that no frame waits for ever. Does not wait.
    void stop();
    /// stop(), and waits until the thread has ended, which then calls the host no more. One whose step has not ended
    /// by then is behind what never ends on its queue.
    void end(std::uint64_t grace_ns);

    // Any thread.
    [[nodiscard]] SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns) const;
    [[nodiscard]] SluiceSimulationStats stats() const;
    [[nodiscard]] Result<SluiceBodies> bodies(std::uint64_t value) const { return reports_.at(value); }

  private:
    struct Request {
        std::uint64_t value;
        double seconds;
        std::vector<BodyTarget> targets;
        std::unique_ptr<FlowSettings> flow;  ///< may be none
        std::unique_ptr<LiveStart> start;    ///< likewise
    };

    [[nodiscard]] Status start(const LiveSetup& setup);
    [[nodiscard]] bool oneQueue() const;
    [[nodiscard]] bool stopping() const;
    [[nodiscard]] std::optional<Request> next();
    void run();
    void reach(const Request& request);
    [[nodiscard]] Status advance(const Request& request);
    [[nodiscard]] Status beginAnew(const LiveStart& start);
    [[nodiscard]] Status waitForFrames(std::uint64_t value);
    [[nodiscard]] Status waitForFrame(std::uint64_t signal, std::uint64_t value, const char* why);
    [[nodiscard]] Status look(std::uint64_t value);
    [[nodiscard]] std::string late() const;
    void takeDepth(SeenDepth depth, std::uint64_t value);
    void driveBodies();
    [[nodiscard]] Status publish(std::uint64_t value);
    void fail(std::uint64_t value, const Error& error);
    void signalFromHere(std::uint64_t value) const;
    [[nodiscard]] std::uint64_t counter() const;

    const RendererTimeline& timeline_;
    Tracer tracer_;
    std::unique_ptr<Device> device_;  ///< a view, with the simulation's queue
    double longest_step_;
    std::uint32_t most_particles_;
    bool shaped_, foams_, mixed_;
    SimulationSettings settings_;  ///< as they were given, but for what has become of the fluids
    BodyReports reports_;
    VkSemaphore semaphore_ = VK_NULL_HANDLE;
    std::unique_ptr<Solver> solver_;
    std::unique_ptr<OutputSlots> slots_;
    std::uint32_t depth_scale_;
    float depth_thickness_;
    SeenDepth seen_by_;               ///< what the solver reads; the thread's
    std::uint64_t depths_freed_ = 0;  ///< how often it has let go of one; likewise

    double owed_ = 0.0;                   ///< s, asked for and too little for a step; the thread's
    std::uint64_t waited_ = 0;            ///< last frame that it has waited for; likewise
    std::vector<BodyTarget> targets_;     ///< likewise of values without a step
    std::vector<BodyTarget> asked_;       ///< by setBody() since the last simulate(); the renderer's thread's
    std::unique_ptr<FlowSettings> flow_;  ///< by setFlow(), likewise
    std::unique_ptr<LiveStart> start_;    ///< by reset(), likewise

    mutable std::mutex mutex_;  ///< guards all below
    mutable std::condition_variable changed_;
    std::deque<Request> requests_;
    SeenDepths seen_;
    std::vector<std::uint64_t> readers_;  ///< by slot: signal value of the last frame that draws from it
    std::vector<std::uint32_t> living_;   ///< by slot: particles, once its value has been submitted
    bool stop_ = false;
    bool ended_ = false;           ///< the thread calls nobody any more
    std::uint64_t held_by_ = 0;    ///< the frame that the thread waits for, or 0
    std::uint64_t submitted_ = 0;  ///< last value whose last work has been submitted, or that failed for good
    SluiceSimulationStats stats_{};
    std::thread thread_;
};

}  // namespace sluice::vk
