// SPDX-License-Identifier: MIT
#include "frame/frame_ring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "device/commands.hpp"
#include "device/structs.hpp"
#include "sluice/trace.hpp"

namespace sluice::vk {
namespace {

void fillPasses(SluiceFrameStats& stats, const std::vector<PassLabel>& labels, const std::vector<GpuSpan>& spans) {
    stats.pass_count = static_cast<std::uint32_t>(labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        SluicePassStats& pass = stats.passes[i];
        const std::size_t length = std::min(std::strlen(labels[i].name), sizeof(pass.name) - 1);
        std::memcpy(pass.name, labels[i].name, length);
        pass.name[length] = '\0';
        pass.nanoseconds = spans[i].duration_ns;
        pass.elements = labels[i].elements;
        pass.bytes = labels[i].bytes;
        pass.is_particles = labels[i].elements_are_particles ? 1 : 0;
        pass.dispatches = labels[i].dispatches;
    }
}

}  // namespace

FrameRing::FrameRing(const Device& device, RendererTimeline& timeline, const Tracer& tracer, std::uint32_t slots)
    : device_(device), timeline_(timeline), tracer_(tracer) {
    for (std::uint32_t i = 0; i < slots; ++i) {
        slots_.push_back(std::make_unique<Slot>(device));
    }
}

Result<std::unique_ptr<FrameRing>> FrameRing::create(const Device& device, RendererTimeline& timeline,
                                                     const Tracer& tracer, std::uint32_t slots) {
    auto ring = std::make_unique<FrameRing>(device, timeline, tracer, slots);
    for (const auto& slot : ring->slots_) {
        if (Status status = ring->createSlot(*slot); !status) {
            return status.error();
        }
    }
    return ring;
}

FrameRing::~FrameRing() {
    for (const auto& slot : slots_) {
        device_.fn.vkDestroyCommandPool(device_.handle, slot->pool, nullptr);
    }
}

Status FrameRing::createSlot(Slot& slot) const {
    if (Status status = createCommands(device_, slot.pool, slot.commands); !status) {
        return status;
    }
    return slot.timer.create();
}

Status FrameRing::waitForSlot(std::uint32_t image_set) {
    Slot& slot = *slots_[image_set];
    if (!slot.running) {
        return {};
    }
    const SluiceResult result = timeline_.wait(slot.stats.frame, kPatienceNs);
    if (result == SLUICE_TIMEOUT) {
        if (const SimulatedFluid& fluid = slot.simulated; fluid.value != 0 && fluid.waits) {
            std::uint64_t reached = 0;
            (void)device_.fn.vkGetSemaphoreCounterValue(device_.handle, fluid.semaphore, &reached);
            if (reached < fluid.value) {
                return Error{
                    SLUICE_ERROR_INTERNAL, fmt::format("frame {}", slot.stats.frame),
                    fmt::format("not finished after {} s: the simulation's value {} is not there, the last is {}",
                                kPatienceNs / 1'000'000'000, fluid.value, reached),
                    "simulate fewer particles or less time a value, or wait with simulation_wait"};
            }
        }
        return Error{SLUICE_ERROR_INTERNAL, fmt::format("frame {}", slot.stats.frame),
                     fmt::format("not finished after {} s, so its image set {} is not free",
                                 kPatienceNs / 1'000'000'000, image_set),
                     "check that the host signals the value that it promised for that frame"};
    }
    if (result != SLUICE_OK) {
        return Error{result, fmt::format("frame {}", slot.stats.frame), "vkWaitSemaphores failed",
                     "destroy the renderer and create it again"};
    }
    finish(slot);
    return {};
}

Status FrameRing::waitForAll() {
    for (std::uint32_t i = 0; i < slots_.size(); ++i) {
        if (Status status = waitForSlot(i); !status) {
            return status;
        }
    }
    return {};
}

Status FrameRing::record(Slot& slot, const SluiceFrame& frame, const SharedImages& images,
                         const PassRecorder& record) const {
    VkResult result = device_.fn.vkResetCommandPool(device_.handle, slot.pool, 0);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkResetCommandPool");
    }
    auto begin = vkStruct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    result = device_.fn.vkBeginCommandBuffer(slot.commands, &begin);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "vkBeginCommandBuffer");
    }
    slot.timer.frameBegin(slot.commands);
    images.recordAcquire(slot.commands, frame.image_set);
    ParticleBuffers particles;
    if (slot.particles) {
        recordUpload(device_, slot.commands, *slot.particles);
        particles = slot.particles->buffers();
    }
    if (slot.simulated.value != 0) {
        particles = slot.simulated.particles;  // the wait for the simulation has made them visible
    }
    if (Status status = record(slot.commands, particles, slot.timer); !status) {
        return status;
    }
    images.recordRelease(slot.commands, frame.image_set);
    slot.timer.frameEnd(slot.commands);
    result = device_.fn.vkEndCommandBuffer(slot.commands);
    if (result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("vkEndCommandBuffer of frame {}", frame.frame));
    }
    return {};
}

Status FrameRing::enqueue(Slot& slot, const SluiceFrame& frame, const SubmitSemaphores& semaphores) const {
    auto commands = vkStruct<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
    commands.commandBuffer = slot.commands;
    auto info = vkStruct<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    info.waitSemaphoreInfoCount = static_cast<std::uint32_t>(semaphores.waits.size());
    info.pWaitSemaphoreInfos = semaphores.waits.data();
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    info.signalSemaphoreInfoCount = static_cast<std::uint32_t>(semaphores.signals.size());
    info.pSignalSemaphoreInfos = semaphores.signals.data();
    const bool skip_wait = (frame.flags & SLUICE_FRAME_SKIP_WAIT) != 0;
    const HostPromise promise = timeline_.promiseOf(frame.wait_value, skip_wait);
    if (const VkResult result = device_.submit(info, VK_NULL_HANDLE, promise); result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("vkQueueSubmit2 of frame {}", frame.frame));
    }
    return {};
}

Status FrameRing::submit(const SluiceFrame& frame, const SharedImages& images, const FrameFluid& fluid,
                         const PassRecorder& passes) {
    const std::uint64_t started = tracer_.now();
    const bool skip_wait = (frame.flags & SLUICE_FRAME_SKIP_WAIT) != 0;
    Slot& slot = *slots_[frame.image_set];
    if (slot.stats.frame != 0) {
        timeline_.retireFrame(slot.stats.frame);
    }
    slot.stats = {};
    const std::shared_ptr<ParticleSet>& particles = fluid.particles;
    slot.particles = particles;
    slot.simulated = fluid.simulated;
    slot.uploads = particles && !particles->recorded;
    slot.image_bytes.clear();
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        const Image& image = images.image(frame.image_set, static_cast<SluiceImageRole>(role));
        slot.image_bytes.push_back(image ? image.allocationSize() : 0);
    }
    slot.cpu_bytes_before = device_.shared_bytes_by_cpu.load(std::memory_order_relaxed);

    Result<SubmitSemaphores> semaphores = timeline_.forSubmit(frame.wait_value, frame.signal_value, skip_wait);
    if (!semaphores) {
        return semaphores.error();
    }
    if (fluid.simulated.value != 0 && fluid.simulated.waits) {
        auto wait = vkStruct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
        wait.semaphore = fluid.simulated.semaphore;
        wait.value = fluid.simulated.value;
        wait.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        semaphores.value().waits.push_back(wait);
    }
    if (Status status = record(slot, frame, images, passes); !status) {
        return status;
    }
    slot.submitted_ns = started;
    if (Status status = enqueue(slot, frame, semaphores.value()); !status) {
        return status;
    }
    timeline_.submitted(frame.wait_value, frame.signal_value, skip_wait);
    slot.running = true;
    slot.wait_value = skip_wait || timeline_.kind() == SLUICE_TIMELINE_UNSYNCHRONISED ? 0 : frame.wait_value;
    slot.stats.frame = frame.frame;
    if (particles) {
        particles->recorded = true;
        slot.stats.upload_bytes = std::exchange(particles->upload_bytes, 0);
    }
    tracer_.emit({SLUICE_TRACE_SUBMIT, SLUICE_TRACK_RENDERER_CPU, "submit", started, tracer_.now() - started,
                  frame.frame, frame.signal_value, 0, SLUICE_RENDERER_TO_HOST});
    return {};
}

bool FrameRing::finished(const Slot& slot) const {
    return timeline_.wait(slot.stats.frame, 0) == SLUICE_OK;
}

SluiceResult FrameRing::poll(std::uint64_t frame, SluiceFrameStats& stats) {
    for (const auto& slot : slots_) {
        if (slot->stats.frame != frame || frame == 0) {
            continue;
        }
        if (slot->running) {
            const SluiceResult result = timeline_.wait(frame, 0);
            if (result != SLUICE_OK) {
                return result == SLUICE_TIMEOUT ? SLUICE_NOT_READY : result;
            }
            finish(*slot);
        }
        stats = slot->stats;
        return SLUICE_OK;
    }
    return SLUICE_ERROR_INVALID_ARGUMENT;
}

void FrameRing::collect() {
    for (const auto& slot : slots_) {
        if (slot->running && finished(*slot)) {
            finish(*slot);
        }
    }
}

void FrameRing::finish(Slot& slot) {
    // The queue is in order, so earlier frames have ended as well, and their events come first.
    for (;;) {
        const auto earlier = std::min_element(slots_.begin(), slots_.end(), [](const auto& a, const auto& b) {
            return std::pair(!a->running, a->stats.frame) < std::pair(!b->running, b->stats.frame);
        });
        if (!(*earlier)->running || (*earlier)->stats.frame >= slot.stats.frame) {
            break;
        }
        finishOne(**earlier);
    }
    finishOne(slot);
}

void FrameRing::finishOne(Slot& slot) {
    slot.running = false;
    const FrameTimes times = slot.timer.read();
    fillPasses(slot.stats, slot.timer.labels(), times.passes);
    slot.stats.cpu_copy_bytes = device_.shared_bytes_by_cpu.load(std::memory_order_relaxed) - slot.cpu_bytes_before;
    if (slot.uploads) {
        slot.particles->staging = {};
    }
    slot.particles.reset();
    if (tracer_.on()) {
        emit(slot, times);
    }
    slot.simulated.captured = {};
}

void FrameRing::emit(const Slot& slot, const FrameTimes& times) const {
    // Without timestamps the queue's events lie between the submission and now, which is all that is known.
    const std::uint64_t begin = times.frame.begin_ns != 0 ? times.frame.begin_ns : slot.submitted_ns;
    const std::uint64_t end =
        times.frame.begin_ns != 0 ? times.frame.begin_ns + times.frame.duration_ns : monotonicNanoseconds();
    const std::uint64_t frame = slot.stats.frame;
    static constexpr const char* kNames[SLUICE_IMAGE_ROLE_COUNT] = {
        "HOST_COLOUR", "HOST_DEPTH", "FLUID_COLOUR", "FLUID_DEPTH", "FLUID_NORMAL", "FLUID_THICKNESS", "CANARY"};
    constexpr SluiceTrack kQueue = SLUICE_TRACK_RENDERER_QUEUE;
    if (slot.wait_value != 0) {
        tracer_.emit({SLUICE_TRACE_WAIT, kQueue, "queue waits for host", begin, 0, frame, slot.wait_value, 0,
                      SLUICE_HOST_TO_RENDERER});
    }
    if (const SimulatedFluid& fluid = slot.simulated; fluid.value != 0) {
        if (fluid.waits) {
            tracer_.emit({SLUICE_TRACE_WAIT, kQueue, "queue waits for simulation", begin, 0, frame, fluid.value, 0,
                          SLUICE_SIMULATION_TO_RENDERER});
        }
        tracer_.emit({SLUICE_TRACE_ACQUIRE, kQueue, "SIMULATED_FLUID", begin, 0, frame, fluid.value,
                      std::uint64_t{fluid.particles.count} * 12, SLUICE_SIMULATION_TO_RENDERER});
    }
    const DepthRoom& captured = slot.simulated.captured;
    const std::string depth = captured.buffer != nullptr ? captured.buffer->name() : "";
    if (captured.buffer != nullptr) {
        // The host's thread has seen that it is free, before it submitted this.
        tracer_.emit({SLUICE_TRACE_ACQUIRE, kQueue, depth.c_str(), begin, 0, frame, captured.freed,
                      captured.buffer->memory.size(), SLUICE_RENDERER_TO_HOST});
    }
    for (std::size_t role = 0; role < slot.image_bytes.size(); ++role) {
        if (slot.image_bytes[role] != 0) {
            tracer_.emit({SLUICE_TRACE_ACQUIRE, kQueue, kNames[role], begin, 0, frame, slot.wait_value,
                          slot.image_bytes[role], SLUICE_HOST_TO_RENDERER});
        }
    }
    for (std::size_t i = 0; i < slot.timer.labels().size(); ++i) {
        const PassLabel& label = slot.timer.labels()[i];
        tracer_.emit({SLUICE_TRACE_PASS, kQueue, label.name, times.passes[i].begin_ns, times.passes[i].duration_ns,
                      frame, 0, label.bytes, SLUICE_HOST_TO_RENDERER});
    }
    if (captured.buffer != nullptr) {
        tracer_.emit({SLUICE_TRACE_RELEASE, kQueue, depth.c_str(), end, 0, frame, frame, captured.buffer->memory.size(),
                      SLUICE_RENDERER_TO_HOST});
    }
    for (std::size_t role = 0; role < slot.image_bytes.size(); ++role) {
        if (slot.image_bytes[role] != 0) {
            tracer_.emit({SLUICE_TRACE_RELEASE, kQueue, kNames[role], end, 0, frame, frame, slot.image_bytes[role],
                          SLUICE_RENDERER_TO_HOST});
        }
    }
    tracer_.emit({SLUICE_TRACE_SIGNAL, kQueue, "queue signals host", end, 0, frame, frame, 0, SLUICE_RENDERER_TO_HOST});
}

}  // namespace sluice::vk
