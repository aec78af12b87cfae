// SPDX-License-Identifier: MIT
#include "stress/vk/side.hpp"

#include <volk.h>

#include <array>
#include <utility>

#include "device/device.hpp"
#include "device/structs.hpp"
#include "stress/vk/extra_timeline.hpp"
#include "stress/vk/kernel.hpp"
#include "stress/vk/slot_memory.hpp"
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
    std::unique_ptr<SlotMemory> slots;
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
        slots.reset();
        timeline.reset();
        relay = {};
    }

    Status createCommands();
    Status createTimelines();
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

Status VkHere::State::record(VkCommandBuffer buffer, const Turn& turn, const Hand& hand) {
    auto begin = vkStruct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (const VkResult result = device->fn.vkBeginCommandBuffer(buffer, &begin); result != VK_SUCCESS) {
        return vulkanError(result, "vkBeginCommandBuffer");
    }
    std::vector<std::uint32_t> touched = turn.inputs;
    touched.push_back(turn.output);
    slots->transfer(buffer, touched, true, hand.wrong_layout);
    // Bindings without an input show something else that is readable, and the shader does not read it.
    const std::uint32_t other = storage.slots.own(turn.output == storage.slots.own(0) ? 1 : 0);
    std::array<SlotRef, kMaxInputs> inputs{};
    for (std::uint32_t j = 0; j < kMaxInputs; ++j) {
        inputs.at(j) = slots->ref(j < turn.inputs.size() ? turn.inputs[j] : other);
    }
    const TurnConstants constants{turn.salt, static_cast<std::uint32_t>(turn.inputs.size()), storage.width,
                                  storage.texels()};
    if (Status status = kernel->record(buffer, inputs, slots->ref(turn.output), constants); !status) {
        return status;
    }
    slots->transfer(buffer, touched, false);
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
    auto slots = SlotMemory::create(*state_->device, storage);
    if (!slots) {
        return slots.error();
    }
    state_->slots = std::move(slots).value();
    return state_->createTimelines();
}

Result<ExportedSlot> VkHere::exportSlot(std::uint32_t slot) {
    return state_->slots->exportSlot(slot);
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
    return state_->slots->read(slot);
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
