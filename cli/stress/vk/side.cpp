// SPDX-License-Identifier: MIT
#include "stress/vk/side.hpp"

#include <volk.h>

#include <array>
#include <span>
#include <utility>

#include "device/capabilities.hpp"
#include "device/device.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"
#include "memory/buffer.hpp"
#include "memory/image.hpp"
#include "stress/vk/extra_timeline.hpp"
#include "stress/vk/kernel.hpp"
#include "stress/vk/shared_buffer.hpp"
#include "sync/binary_pool.hpp"
#include "sync/renderer_timeline.hpp"

namespace sluice::stress {

using vk::vkStruct;
using vk::vulkanError;

namespace {

constexpr std::uint32_t kCommandBuffers = 64;
/// A command buffer is taken again when the submission that came this many before the present one has ended; the one
/// that used it last came before that.
constexpr std::uint32_t kBusy = kCommandBuffers - 4;
constexpr std::uint64_t kReuseTimeoutNs = 10'000'000'000;

SluiceFormat sharedFormat(Resource resource) {
    return resource == Resource::Colour ? SLUICE_FORMAT_RGBA8
           : resource == Resource::D32F ? SLUICE_FORMAT_D32F
                                        : SLUICE_FORMAT_R32F;
}

class VkHere final : public VkSide {
  public:
    struct State;
    explicit VkHere(std::unique_ptr<State> state) : state_(std::move(state)) {}
    VkHere(const VkHere&) = delete;
    VkHere& operator=(const VkHere&) = delete;
    ~VkHere() override;

    [[nodiscard]] const SluiceRendererCapabilities& capabilities() const override;
    [[nodiscard]] Status allocate(const Storage& storage) override;
    [[nodiscard]] Result<ExportedSlot> exportSlot(std::uint32_t slot) override;
    [[nodiscard]] Status submit(const Turn& turn, const Hand& hand) override;
    [[nodiscard]] Status signal(std::uint64_t value) override;
    [[nodiscard]] SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns) override;
    [[nodiscard]] Status relaySignal(RelayLeg leg, std::uint64_t value) override;
    [[nodiscard]] SluiceResult relayWait(RelayLeg leg, std::uint64_t value, std::uint64_t timeout_ns) override;
    [[nodiscard]] bool drain(std::uint64_t timeout_ns) override;
    [[nodiscard]] Result<std::vector<std::byte>> read(std::uint32_t slot) override;

  private:
    std::unique_ptr<State> state_;
};

struct VkHere::State {
    std::unique_ptr<vk::Device> device;
    Storage storage;
    std::vector<vk::Image> images;                       // by slot, unless the resource is a buffer
    std::vector<std::unique_ptr<SharedBuffer>> buffers;  // by slot, if it is
    std::unique_ptr<Kernel> kernel;
    std::unique_ptr<vk::RendererTimeline> timeline;
    std::array<std::unique_ptr<ExtraTimeline>, 2> relay;
    VkCommandPool pool = VK_NULL_HANDLE;
    std::array<VkCommandBuffer, kCommandBuffers> commands{};
    std::array<std::uint64_t, kCommandBuffers> signals{};  // what each submission signals, or the one before it
    std::uint64_t submissions = 0, last_signal = 0;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (device != nullptr && device->handle != VK_NULL_HANDLE) {
            device->fn.vkDeviceWaitIdle(device->handle);
            clear();
            device->fn.vkDestroyCommandPool(device->handle, pool, nullptr);
        }
    }

    void clear() {
        kernel.reset();
        images.clear();
        buffers.clear();
        timeline.reset();
        relay = {};
    }

    [[nodiscard]] bool isBuffer() const { return storage.resource == Resource::Buffer; }
    [[nodiscard]] SlotRef ref(std::uint32_t slot) const {
        return isBuffer() ? SlotRef{VK_NULL_HANDLE, VK_NULL_HANDLE, buffers[slot]->buffer()}
                          : SlotRef{images[slot].image(), images[slot].view(), VK_NULL_HANDLE};
    }
    Status createCommands();
    Status createSlots();
    Status createTimelines();
    void transfer(VkCommandBuffer buffer, std::span<const std::uint32_t> slots, bool acquire,
                  std::uint32_t wrong_layout = kNoSlot) const;
    Status record(VkCommandBuffer buffer, const Turn& turn, const Hand& hand);
};

Status VkHere::State::createCommands() {
    auto info = vkStruct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    info.queueFamilyIndex = device->queue_family;
    VkResult result = device->fn.vkCreateCommandPool(device->handle, &info, nullptr, &pool);
    if (result == VK_SUCCESS) {
        auto allocate = vkStruct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        allocate.commandPool = pool;
        allocate.commandBufferCount = kCommandBuffers;
        result = device->fn.vkAllocateCommandBuffers(device->handle, &allocate, commands.data());
    }
    return result == VK_SUCCESS ? Status{} : Status{vulkanError(result, "command buffers of the stress test")};
}

Status VkHere::State::createSlots() {
    for (std::uint32_t slot = 0; slot < storage.slots.count(); ++slot) {
        const bool shared = slot < storage.slots.shared();
        if (isBuffer()) {
            auto buffer = SharedBuffer::create(*device, VkDeviceSize{storage.texels()} * 4, shared);
            if (!buffer) {
                return buffer.error();
            }
            buffers.push_back(std::move(buffer).value());
            continue;
        }
        auto image = vk::Image::create(
            *device, {formatOf(storage.resource), storage.width, storage.height,
                      vk::sharedUsage(device->instance_fn, device->physical, sharedFormat(storage.resource)), shared,
                      "stress slot"});
        if (!image) {
            return image.error();
        }
        images.push_back(std::move(image).value());
    }
    if (isBuffer()) {
        return {};
    }
    return vk::runOnce(*device, [this](VkCommandBuffer buffer) {
        std::vector<std::uint32_t> all;
        for (std::uint32_t slot = 0; slot < images.size(); ++slot) {
            vk::fullBarrier(*device, buffer, images[slot].image(), images[slot].aspect(), VK_IMAGE_LAYOUT_UNDEFINED,
                            VK_IMAGE_LAYOUT_GENERAL);
            all.push_back(slot);
        }
        transfer(buffer, all, false);
    });
}

Status VkHere::State::createTimelines() {
    // The kind that lets a submission wait for what the host has not signalled yet; what makes "finish" is the caller's
    // wait for each submission.
    auto made = vk::RendererTimeline::create(*device, SLUICE_TIMELINE_BRIDGED);
    if (!made) {
        return made.error();
    }
    timeline = std::move(made).value();
    for (auto& leg : relay) {
        if (storage.slots.shape.relay) {
            auto semaphore = vk::createSemaphore(*device, VK_SEMAPHORE_TYPE_TIMELINE, false, "relay");
            if (!semaphore) {
                return semaphore.error();
            }
            leg = std::make_unique<ExtraTimeline>(*device, semaphore.value());
        }
    }
    signals = {};
    submissions = last_signal = 0;
    return {};
}

/// Between the two APIs for shared slots; within the queue for the side's own.
void VkHere::State::transfer(VkCommandBuffer buffer, std::span<const std::uint32_t> slots, bool acquire,
                             std::uint32_t wrong_layout) const {
    for (const std::uint32_t slot : slots) {
        const bool shared = slot < storage.slots.shared();
        const std::uint32_t external = shared ? VK_QUEUE_FAMILY_EXTERNAL : VK_QUEUE_FAMILY_IGNORED;
        const std::uint32_t here = shared ? device->queue_family : VK_QUEUE_FAMILY_IGNORED;
        const std::uint32_t from = acquire ? external : here;
        const std::uint32_t to = acquire ? here : external;
        if (!isBuffer()) {
            const auto old = slot == wrong_layout ? static_cast<VkImageLayout>(kWrongLayout) : VK_IMAGE_LAYOUT_GENERAL;
            vk::fullBarrier(*device, buffer, images[slot].image(), images[slot].aspect(), old, VK_IMAGE_LAYOUT_GENERAL,
                            from, to);
            continue;
        }
        auto barrier = vkStruct<VkBufferMemoryBarrier2>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2);
        barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.srcQueueFamilyIndex = from;
        barrier.dstQueueFamilyIndex = to;
        barrier.buffer = buffers[slot]->buffer();
        barrier.size = VK_WHOLE_SIZE;
        auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
        dependency.bufferMemoryBarrierCount = 1;
        dependency.pBufferMemoryBarriers = &barrier;
        device->fn.vkCmdPipelineBarrier2(buffer, &dependency);
    }
}

Status VkHere::State::record(VkCommandBuffer buffer, const Turn& turn, const Hand& hand) {
    auto begin = vkStruct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (const VkResult result = device->fn.vkBeginCommandBuffer(buffer, &begin); result != VK_SUCCESS) {
        return vulkanError(result, "vkBeginCommandBuffer");
    }
    std::vector<std::uint32_t> touched = turn.inputs;
    touched.push_back(turn.output);
    transfer(buffer, touched, true, hand.wrong_layout);
    // Bindings without an input show something else that is readable, and the shader does not read it.
    const std::uint32_t other = storage.slots.own(turn.output == storage.slots.own(0) ? 1 : 0);
    std::array<SlotRef, kMaxInputs> inputs{};
    for (std::uint32_t j = 0; j < kMaxInputs; ++j) {
        inputs.at(j) = ref(j < turn.inputs.size() ? turn.inputs[j] : other);
    }
    const TurnConstants constants{turn.salt, static_cast<std::uint32_t>(turn.inputs.size()), storage.width,
                                  storage.texels()};
    if (Status status = kernel->record(buffer, inputs, ref(turn.output), constants); !status) {
        return status;
    }
    transfer(buffer, touched, false);
    const VkResult result = device->fn.vkEndCommandBuffer(buffer);
    return result == VK_SUCCESS ? Status{} : Status{vulkanError(result, "vkEndCommandBuffer")};
}

VkHere::~VkHere() = default;

const SluiceRendererCapabilities& VkHere::capabilities() const {
    return state_->device->capabilities;
}

Status VkHere::allocate(const Storage& storage) {
    state_->clear();
    state_->storage = storage;
    auto kernel = Kernel::create(*state_->device, storage);
    if (!kernel) {
        return kernel.error();
    }
    state_->kernel = std::move(kernel).value();
    if (Status status = state_->createSlots(); !status) {
        return status;
    }
    return state_->createTimelines();
}

Result<ExportedSlot> VkHere::exportSlot(std::uint32_t slot) {
    auto fd = state_->isBuffer() ? state_->buffers[slot]->exportFd() : state_->images[slot].exportFd();
    if (!fd) {
        return fd.error();
    }
    return ExportedSlot{std::move(fd).value(), state_->isBuffer() ? state_->buffers[slot]->allocationSize()
                                                                  : state_->images[slot].allocationSize()};
}

Status VkHere::submit(const Turn& turn, const Hand& hand) {
    State& s = *state_;
    const std::size_t index = s.submissions % kCommandBuffers;
    if (s.submissions >= kBusy &&
        wait(s.signals.at((s.submissions - kBusy) % kCommandBuffers), kReuseTimeoutNs) != SLUICE_OK) {
        return Error{SLUICE_TIMEOUT, "command buffers of the stress test",
                     "a submission of long ago has not ended within 10 s", ""};
    }
    VkCommandBuffer commands = s.commands.at(index);
    if (Status status = s.record(commands, turn, hand); !status) {
        return status;
    }
    Result<vk::SubmitSemaphores> semaphores = s.timeline->forSubmit(hand.wait, hand.signal, !hand.waits);
    if (!semaphores) {
        return semaphores.error();
    }
    auto& [waits, signals] = semaphores.value();
    if (hand.signal == 0) {
        signals.clear();
    }
    auto buffer = vkStruct<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
    buffer.commandBuffer = commands;
    auto info = vkStruct<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &buffer;
    info.waitSemaphoreInfoCount = static_cast<std::uint32_t>(waits.size());
    info.pWaitSemaphoreInfos = waits.data();
    info.signalSemaphoreInfoCount = static_cast<std::uint32_t>(signals.size());
    info.pSignalSemaphoreInfos = signals.data();
    if (const VkResult result = s.device->fn.vkQueueSubmit2(s.device->queue, 1, &info, VK_NULL_HANDLE);
        result != VK_SUCCESS) {
        return vulkanError(result, "vkQueueSubmit2 of the stress test");
    }
    s.timeline->submitted(hand.wait, hand.signal, !hand.waits);
    s.last_signal = hand.signal != 0 ? hand.signal : s.last_signal;
    s.signals.at(index) = s.last_signal;
    ++s.submissions;
    return {};
}

Status VkHere::signal(std::uint64_t value) {
    return state_->timeline->signal(value);
}

SluiceResult VkHere::wait(std::uint64_t value, std::uint64_t timeout_ns) {
    return state_->timeline->wait(value, timeout_ns);
}

Status VkHere::relaySignal(RelayLeg leg, std::uint64_t value) {
    return state_->relay.at(static_cast<std::size_t>(leg))->signal(value);
}

SluiceResult VkHere::relayWait(RelayLeg leg, std::uint64_t value, std::uint64_t timeout_ns) {
    return state_->relay.at(static_cast<std::size_t>(leg))->wait(value, timeout_ns);
}

bool VkHere::drain(std::uint64_t timeout_ns) {
    return state_->timeline == nullptr || wait(state_->last_signal, timeout_ns) == SLUICE_OK;
}

Result<std::vector<std::byte>> VkHere::read(std::uint32_t slot) {
    State& s = *state_;
    const std::size_t bytes = std::size_t{s.storage.texels()} * 4;
    if (!s.isBuffer()) {
        return vk::downloadImage(*s.device, s.images[slot], 4);
    }
    auto staging = vk::Buffer::create(
        *s.device, {bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::BufferPlace::Readback, "stress read-back"});
    if (!staging) {
        return staging.error();
    }
    Status copied = vk::runOnce(*s.device, [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        s.device->fn.vkCmdCopyBuffer(commands, s.buffers[slot]->buffer(), staging.value().buffer(), 1, &region);
        auto barrier = vkStruct<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
        auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
        dependency.memoryBarrierCount = 1;
        dependency.pMemoryBarriers = &barrier;
        s.device->fn.vkCmdPipelineBarrier2(commands, &dependency);
    });
    if (!copied) {
        return copied.error();
    }
    const auto mapped = staging.value().mapped();
    return std::vector<std::byte>(mapped.begin(), mapped.end());
}

}  // namespace

Result<std::unique_ptr<VkSide>> VkSide::create(const SluiceHostCapabilities& host) {
    auto state = std::make_unique<VkHere::State>();
    vk::DeviceRequest request;
    request.host = host;
    auto device = vk::Device::create(request);
    if (!device) {
        return device.error();
    }
    state->device = std::move(device).value();
    if (Status status = state->createCommands(); !status) {
        return status.error();
    }
    return std::unique_ptr<VkSide>(std::make_unique<VkHere>(std::move(state)));
}

}  // namespace sluice::stress
