// SPDX-License-Identifier: MIT
#include "live/live_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <system_error>
#include <utility>

#include "device/structs.hpp"
#include "frame/frame_ring.hpp"
#include "sluice/blocked_signals.hpp"
#include "sluice/trace.hpp"
#include "sync/binary_pool.hpp"

namespace sluice::vk {
namespace {

/// How often a wait of the thread looks whether it has to end.
constexpr std::uint64_t kLookNs = 50'000'000;
/// Of the longest step: less than that is no step, 1/dt of it would be beyond floats.
constexpr double kLeastPart = 1.0 / 1024.0;
constexpr std::uint64_t kBytesOfParticle = 6 * sizeof(float);
constexpr const char* kFluidName = "SIMULATED_FLUID";

std::vector<BodyState> startsOf(const std::vector<Body>& bodies) {
    std::vector<BodyState> starts(bodies.size());
    std::transform(bodies.begin(), bodies.end(), starts.begin(), startOf);
    return starts;
}

}  // namespace

Error noSimulation(const char* call) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, call, "there is no simulation", "call set_simulation first"};
}

LiveSimulation::LiveSimulation(const RendererTimeline& timeline, const Tracer& tracer, std::unique_ptr<Device> device,
                               const LiveSetup& setup)
    : timeline_(timeline),
      tracer_(tracer),
      device_(std::move(device)),
      longest_step_(setup.longest_step),
      most_particles_(setup.most_particles),
      shaped_(setup.anisotropy.has_value()),
      foams_(setup.foam.has_value()),
      mixed_(setup.settings.fluids.size() > 1),
      settings_(setup.settings),
      reports_(setup.frames_in_flight + 1, startsOf(setup.settings.bodies)),
      depth_scale_(setup.depth_scale),
      depth_thickness_(setup.depth_thickness),
      seen_(setup.depth_lag),
      readers_(setup.frames_in_flight + 1),
      living_(setup.frames_in_flight + 1) {
    stats_.struct_size = sizeof(stats_);
    stats_.particle_count = static_cast<std::uint32_t>(setup.position.size() / 3);
}

Result<std::unique_ptr<LiveSimulation>> LiveSimulation::create(const Device& device, const RendererTimeline& timeline,
                                                               const Tracer& tracer, const LiveSetup& setup) {
    auto made = std::make_unique<LiveSimulation>(timeline, tracer, device.computeView(), setup);
    made->stats_.own_queue = device.compute_queue != VK_NULL_HANDLE ? 1 : 0;
    if (Status status = made->start(setup); !status) {
        return status.error();
    }
    device.log(SLUICE_LOG_INFO,
               fmt::format("simulation of {} particles on {}, {} output slots", made->stats_.particle_count,
                           made->oneQueue() ? "the queue of the frames" : "a queue of its own", made->slots_->count()));
    return made;
}

Status LiveSimulation::start(const LiveSetup& setup) {
    Result<VkSemaphore> semaphore =
        createSemaphore(*device_, VK_SEMAPHORE_TYPE_TIMELINE, false, "timeline simulation to renderer");
    if (!semaphore) {
        return semaphore.error();
    }
    semaphore_ = semaphore.value();
    Result<std::unique_ptr<Solver>> solver = Solver::create(*device_, setup.settings);
    if (!solver) {
        return solver.error();
    }
    solver_ = std::move(solver).value();
    if (Status status = solver_->setParticles(setup.position, setup.velocity, setup.fluid); !status) {
        return status;
    }
    Result<std::unique_ptr<OutputSlots>> slots =
        OutputSlots::create(*device_, setup.frames_in_flight + 1, most_particles_, setup.settings.radius,
                            setup.anisotropy, setup.foam, mixed_);
    if (!slots) {
        return slots.error();
    }
    slots_ = std::move(slots).value();
    try {
        const BlockedSignals quiet;  // in the host's process they are the host's to take
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error& why) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, "simulation", fmt::format("no thread can be started: {}", why.what()),
                     ""};
    }
    return {};
}

LiveSimulation::~LiveSimulation() {
    stop();
    if (thread_.joinable()) {
        thread_.join();
    }
    // A wait has seen the last signal, yet Mesa's submission thread still holds points of the semaphore until it turns
    // to its next work: freed before that, it writes into freed memory (seen with 22.3.6).
    (void)device_->waitIdle();
    solver_.reset();
    slots_.reset();
    device_->fn.vkDestroySemaphore(device_->handle, semaphore_, nullptr);
}

bool LiveSimulation::oneQueue() const {
    return stats_.own_queue == 0;
}

void LiveSimulation::stop() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    changed_.notify_all();
}

void LiveSimulation::end(std::uint64_t grace_ns) {
    stop();
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, std::chrono::nanoseconds(grace_ns), [this] { return ended_; })) {
        lock.unlock();
        if (thread_.joinable()) {
            thread_.join();
        }
    }
}

bool LiveSimulation::stopping() const {
    const std::lock_guard lock(mutex_);
    return stop_;
}

Status LiveSimulation::simulate(std::uint64_t value, double seconds) {
    const std::lock_guard lock(mutex_);
    if (value != stats_.asked + 1) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulate",
                     fmt::format("value {} came after {}, {} was expected", value, stats_.asked, stats_.asked + 1),
                     "number values from 1 without gaps"};
    }
    if (stop_) {
        return Error{SLUICE_ERROR_INTERNAL, "simulate", "the simulation's thread has ended",
                     "call set_simulation again"};
    }
    requests_.push_back({value, seconds, std::exchange(asked_, {}), std::move(flow_), std::move(start_)});
    stats_.asked = value;
    if (value > slots_->count()) {
        seen_.passed(value - slots_->count());  // fluid() refuses it from now on
    }
    changed_.notify_all();
    return {};
}

Status LiveSimulation::setBody(const BodyTarget& target) {
    if (target.body >= settings_.bodies.size() || !settings_.bodies[target.body].driven) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "set_body",
                     fmt::format("body {} of {} is none that is driven", target.body, settings_.bodies.size()),
                     "give it the motion SLUICE_BODY_DRIVEN"};
    }
    asked_.push_back(target);
    return {};
}

Status LiveSimulation::setFlow(const FlowSettings& flow) {
    if (flow.emitters.size() > settings_.sources.emitters.size()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "flow.emitters",
                     fmt::format("expected at most the {} of set_simulation, found {}",
                                 settings_.sources.emitters.size(), flow.emitters.size()),
                     "begin with as many, and shut them"};
    }
    SimulationSettings changed = settings_;
    apply(flow, changed);
    if (Status status = checkChange(settings_.fluids, changed.fluids); !status) {
        return status;
    }
    if (Status status = checkSettings(changed); !status) {
        return status;
    }
    flow_ = std::make_unique<FlowSettings>(flow);
    flow_->fluids = settings_.fluids = changed.fluids;  // all of them: the solver may know a list of one as none
    return {};
}

Result<SimulatedFluid> LiveSimulation::fluid(std::uint64_t value, bool skip_wait) {
    std::unique_lock lock(mutex_);
    if (value == 0 || value > stats_.asked || value + slots_->count() <= stats_.asked) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "frame.simulation",
                     fmt::format("value {} cannot be drawn: {} have been asked for, and the last {} of them are kept",
                                 value, stats_.asked, slots_->count()),
                     "call simulate first, and no more than frames_in_flight values ahead of the frames"};
    }
    seen_.passed(value - 1);  // nobody draws those any more
    changed_.notify_all();
    if (oneQueue() && !skip_wait) {
        const auto patience = std::chrono::nanoseconds(FrameRing::kPatienceNs);
        if (!changed_.wait_for(lock, patience, [&] { return submitted_ >= value || stop_; })) {
            return Error{SLUICE_ERROR_INTERNAL, fmt::format("simulation value {}", value), late(),
                         held_by_ != 0 ? "check that the host signals the value that it promised for that frame"
                                       : "simulate fewer particles or less time a value, or wait for it with "
                                         "simulation_wait before the frame"};
        }
    }
    ParticleBuffers particles = slots_->buffers(value);
    if (submitted_ >= value) {
        particles.count = living_[value % living_.size()];
    }
    return SimulatedFluid{particles, value, semaphore_, !skip_wait};
}

std::string LiveSimulation::late() const {
    const std::uint64_t seconds = FrameRing::kPatienceNs / 1'000'000'000;
    if (held_by_ != 0) {
        return fmt::format("not there after {} s: frame {}, which draws from its slot, has not ended", seconds,
                           held_by_);
    }
    return fmt::format("not there after {} s, and the frame must not be submitted before it: one queue has both",
                       seconds);
}

Result<DepthRoom> LiveSimulation::captureRoom(const Device& device, std::uint64_t value, VkDeviceSize bytes) {
    const std::lock_guard lock(mutex_);
    if (depth_scale_ == 0 || stats_.failed != 0 || seen_.known(value)) {
        return DepthRoom{};
    }
    return seen_.room(device, bytes);
}

void LiveSimulation::drawn(std::uint64_t value, std::uint64_t signal_value,
                           const std::shared_ptr<const DepthBuffer>& captured) {
    const std::lock_guard lock(mutex_);
    seen_.drawn(value, {captured, signal_value});
    changed_.notify_all();
    std::uint64_t& reader = readers_[value % readers_.size()];
    reader = std::max(reader, signal_value);
}

SluiceResult LiveSimulation::wait(std::uint64_t value, std::uint64_t timeout_ns) const {
    const auto deadline = deadlineIn(timeout_ns);
    {
        // For the thread, which has seen the end of it; HostPromises says why not at once.
        std::unique_lock lock(mutex_);
        if (!changed_.wait_until(lock, deadline, [&] { return submitted_ >= value || ended_; })) {
            return SLUICE_TIMEOUT;
        }
    }
    auto info = vkStruct<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    info.semaphoreCount = 1;
    info.pSemaphores = &semaphore_;
    info.pValues = &value;
    const VkResult result = device_->fn.vkWaitSemaphores(device_->handle, &info, leftUntil(deadline));
    if (result == VK_SUCCESS) {
        return SLUICE_OK;
    }
    return result == VK_TIMEOUT ? SLUICE_TIMEOUT : vulkanError(result, "").code;
}

SluiceSimulationStats LiveSimulation::stats() const {
    const std::uint64_t reached = counter();
    const std::lock_guard lock(mutex_);
    SluiceSimulationStats out = stats_;
    out.reached = reached;
    return out;
}

std::uint64_t LiveSimulation::counter() const {
    std::uint64_t value = 0;
    return device_->fn.vkGetSemaphoreCounterValue(device_->handle, semaphore_, &value) == VK_SUCCESS ? value : 0;
}

// ---- the simulation's thread

std::optional<LiveSimulation::Request> LiveSimulation::next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stop_ || !requests_.empty(); });
    if (stop_) {
        return std::nullopt;
    }
    Request request = std::move(requests_.front());
    requests_.pop_front();
    return request;
}

void LiveSimulation::run() {
    try {
        while (const std::optional<Request> request = next()) {
            reach(*request);
        }
    } catch (const std::exception& why) {
        fail(counter() + 1, {SLUICE_ERROR_OUT_OF_MEMORY, "simulation", why.what(), ""});
    }
    std::uint64_t asked = 0;
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        asked = stats_.asked;
    }
    // One by one; RendererTimeline::force() says why.
    for (std::uint64_t value = counter() + 1; value <= asked; ++value) {
        signalFromHere(value);
    }
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    changed_.notify_all();
}

void LiveSimulation::reach(const Request& request) {
    const std::uint64_t began = monotonicNanoseconds();
    if (const Status moved = advance(request); !moved) {
        fail(request.value, moved.error());
    }
    if (stopping()) {
        return;
    }
    reports_.close(request.value, solver_->bodies());
    Status status = waitForFrames(request.value);
    if (status && stopping()) {
        return;
    }
    if (status) {
        status = publish(request.value);
    }
    if (!status) {
        fail(request.value, status.error());
        signalFromHere(request.value);
    }
    const std::lock_guard lock(mutex_);
    stats_.last_busy_ns = monotonicNanoseconds() - began;
    stats_.busy_ns += stats_.last_busy_ns;
    submitted_ = request.value;
    changed_.notify_all();
}

Status LiveSimulation::advance(const Request& request) {
    {
        const std::lock_guard lock(mutex_);
        seen_.forget(seen_.sourceOf(request.value));  // here, since a value without a step does not look
    }
    // Also of one that has failed: it may flow again.
    if (Status status = request.flow ? solver_->setFlow(*request.flow) : Status{}; !status) {
        return status;
    }
    if (Status status = request.start ? beginAnew(*request.start) : Status{}; !status) {
        return status;
    }
    {
        const std::lock_guard lock(mutex_);
        if (stats_.failed != 0) {
            return {};  // the last good state it is, from now on
        }
    }
    targets_.insert(targets_.end(), request.targets.begin(), request.targets.end());
    owed_ += request.seconds;
    if (owed_ < kLeastPart * longest_step_) {
        return {};
    }
    if (Status status = look(request.value); !status || stopping()) {
        return status;
    }
    std::uint64_t step_began = tracer_.now();
    driveBodies();
    solver_->watchSteps([&](const StepReport& report, bool kept) {
        if (kept) {
            reports_.add(solver_->bodies(), report.seconds);
        }
        if (stopping()) {
            return false;
        }
        if (!kept) {
            return true;
        }
        const std::uint64_t now = tracer_.now();
        tracer_.emit({SLUICE_TRACE_PASS, SLUICE_TRACK_SIMULATION, "step", step_began, now - step_began, request.value,
                      request.value, 0, SLUICE_SIMULATION_TO_RENDERER});
        step_began = now;
        return true;
    });
    const Result<AdvanceReport> done = solver_->advance(std::exchange(owed_, 0.0), longest_step_);
    if (!done) {
        return done.error();
    }
    const AdvanceReport& report = done.value();
    const std::lock_guard lock(mutex_);
    stats_.particle_count = solver_->count();
    stats_.shortest_step = stats_.steps == 0 ? report.shortest : std::min(stats_.shortest_step, report.shortest);
    stats_.steps += report.steps;
    stats_.steps_taken_again += report.split;
    stats_.fastest = std::max(stats_.fastest, report.speed);
    return {};
}

void LiveSimulation::driveBodies() {
    for (const BodyTarget& target : std::exchange(targets_, {})) {
        solver_->drive(target.body, target.centre, target.turn, owed_);
    }
}

Status LiveSimulation::look(std::uint64_t value) {
    SeenDepth depth;
    {
        std::unique_lock lock(mutex_);
        const std::uint64_t source = depth_scale_ == 0 ? 0 : seen_.sourceOf(value);
        // However long the host's next frame takes: who draws this value, or asks for later ones, ends the wait.
        changed_.wait(lock, [&] { return stop_ || seen_.known(source); });
        depth = seen_.at(source);
    }
    if (depth.buffer == nullptr || depth.buffer == seen_by_.buffer) {
        return {};
    }
    if (Status status = waitForFrame(depth.signal, value, "depth captured"); !status || stopping()) {
        return status;
    }
    takeDepth(std::move(depth), value);
    return {};
}

void LiveSimulation::takeDepth(SeenDepth depth, std::uint64_t value) {
    const auto tell = [&](SluiceTraceKind kind, const DepthBuffer& buffer, std::uint64_t number) {
        tracer_.emit({kind, SLUICE_TRACK_SIMULATION, buffer.name().c_str(), tracer_.now(), 0, value, number,
                      buffer.memory.size(), SLUICE_RENDERER_TO_HOST});
    };
    solver_->useDepthField(depth.buffer->memory.buffer());
    tell(SLUICE_TRACE_ACQUIRE, *depth.buffer, depth.signal);
    if (seen_by_.buffer != nullptr) {
        // Before anybody can find it idle, for which he has to hold the lock.
        tell(SLUICE_TRACE_RELEASE, *seen_by_.buffer, ++depths_freed_);
    }
    const std::lock_guard lock(mutex_);
    if (seen_by_.buffer != nullptr) {
        seen_.letGo(*seen_by_.buffer, depths_freed_);
    }
    seen_by_ = std::move(depth);
}

Status LiveSimulation::waitForFrames(std::uint64_t value) {
    std::uint64_t reader = 0;
    {
        const std::lock_guard lock(mutex_);
        reader = readers_[value % readers_.size()];
    }
    return reader == 0 ? Status{} : waitForFrame(reader, value, "slot free");
}

Status LiveSimulation::waitForFrame(std::uint64_t reader, std::uint64_t value, const char* why) {
    if (reader <= waited_) {
        return {};  // as it has for a later one, whose depth it reads
    }
    {
        const std::lock_guard lock(mutex_);
        held_by_ = reader;
    }
    const std::uint64_t began = tracer_.now();
    // In slices, so that the thread can end whatever becomes of that frame.
    SluiceResult result = SLUICE_TIMEOUT;
    while (result == SLUICE_TIMEOUT && !stopping()) {
        result = timeline_.wait(reader, kLookNs);
    }
    {
        const std::lock_guard lock(mutex_);
        held_by_ = 0;
    }
    if (result != SLUICE_OK && result != SLUICE_TIMEOUT) {
        return Error{result, "simulation", fmt::format("the wait for frame {} failed", reader),
                     "destroy the renderer and create it again"};
    }
    waited_ = result == SLUICE_OK ? reader : waited_;
    tracer_.emit({SLUICE_TRACE_WAIT, SLUICE_TRACK_SIMULATION, why, began, tracer_.now() - began, value, reader, 0,
                  SLUICE_RENDERER_TO_HOST});
    return {};
}

Status LiveSimulation::publish(std::uint64_t value) {
    const std::uint64_t began = tracer_.now();
    auto signal = vkStruct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
    signal.semaphore = semaphore_;
    signal.value = value;
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    if (Status status = slots_->look(*solver_, value); !status) {
        return status;
    }
    const DeviceParticles state = solver_->onDevice();
    if (Status status = slots_->publish(state, value, signal); !status) {
        return status;
    }
    {
        const std::lock_guard lock(mutex_);
        living_[value % living_.size()] = state.living;
    }
    const std::uint64_t bytes = state.living * kBytesOfParticle;
    const std::uint64_t end = tracer_.now();
    tracer_.emit({SLUICE_TRACE_PASS, SLUICE_TRACK_SIMULATION, "publish", began, end - began, value, value, bytes,
                  SLUICE_SIMULATION_TO_RENDERER});
    tracer_.emit({SLUICE_TRACE_RELEASE, SLUICE_TRACK_SIMULATION, kFluidName, end, 0, value, value, bytes,
                  SLUICE_SIMULATION_TO_RENDERER});
    tracer_.emit({SLUICE_TRACE_SIGNAL, SLUICE_TRACK_SIMULATION, "simulation signals renderer", end, 0, value, value, 0,
                  SLUICE_SIMULATION_TO_RENDERER});
    return {};
}

void LiveSimulation::fail(std::uint64_t value, const Error& error) {
    const std::string why = error.message();
    {
        const std::lock_guard lock(mutex_);
        if (stats_.failed != 0 || stop_) {
            return;  // told, or nobody is left to be told
        }
        stats_.failed = value;
        const std::size_t length = std::min(why.size(), sizeof(stats_.message) - 1);
        std::memcpy(&stats_.message[0], why.data(), length);
        stats_.message[length] = '\0';
    }
    device_->log(SLUICE_LOG_ERROR,
                 fmt::format("simulation: value {} and all later ones show the last good state: {}", value, why));
}

void LiveSimulation::signalFromHere(std::uint64_t value) const {
    auto info = vkStruct<VkSemaphoreSignalInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO);
    info.semaphore = semaphore_;
    info.value = value;
    if (counter() < value) {
        (void)device_->fn.vkSignalSemaphore(device_->handle, &info);
    }
}

}  // namespace sluice::vk
