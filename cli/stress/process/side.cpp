// SPDX-License-Identifier: MIT
#include "stress/process/side.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/isolate/shared_timeline.hpp"
#include "stress/process/messages.hpp"
#include "stress/process/vulkan_process.hpp"

namespace sluice::stress {
namespace {

using isolate::SharedTimeline;
using isolate::WaitEnd;

SluiceResult resultOf(WaitEnd end, const SharedTimeline& timeline) {
    switch (end) {
        case WaitEnd::Reached:
            return SLUICE_OK;
        case WaitEnd::Timeout:
            return SLUICE_TIMEOUT;
        case WaitEnd::Failed:
            return timeline.failure();
        case WaitEnd::PeerDead:
        case WaitEnd::Broken:
            break;
    }
    return SLUICE_ERROR_DEVICE_LOST;
}

SluiceDirection directionOf(RelayLeg leg) {
    return leg == RelayLeg::FromGl ? SLUICE_HOST_TO_RENDERER : SLUICE_RENDERER_TO_HOST;
}

class VkElsewhere final : public VkSide {
  public:
    VkElsewhere() = default;
    VkElsewhere(const VkElsewhere&) = delete;
    VkElsewhere& operator=(const VkElsewhere&) = delete;
    ~VkElsewhere() override = default;
    [[nodiscard]] Status start(const SluiceHostCapabilities& host);

    [[nodiscard]] const SluiceRendererCapabilities& capabilities() const override { return capabilities_; }
    [[nodiscard]] Status allocate(const Storage& storage) override;
    [[nodiscard]] Result<ExportedSlot> exportSlot(std::uint32_t slot) override;
    [[nodiscard]] Status submit(const Turn& turn, const Hand& hand) override;
    [[nodiscard]] Status signal(std::uint64_t value) override {
        return timeline_->publish(SLUICE_HOST_TO_RENDERER, value);
    }
    [[nodiscard]] SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns) override {
        return resultOf(timeline_->wait(SLUICE_RENDERER_TO_HOST, value, timeout_ns), *timeline_);
    }
    [[nodiscard]] Status relaySignal(RelayLeg leg, std::uint64_t value) override {
        return relay_->publish(directionOf(leg), value);
    }
    [[nodiscard]] SluiceResult relayWait(RelayLeg leg, std::uint64_t value, std::uint64_t timeout_ns) override {
        return resultOf(relay_->wait(directionOf(leg), value, timeout_ns), *relay_);
    }
    [[nodiscard]] bool drain(std::uint64_t timeout_ns) override;
    [[nodiscard]] Result<std::vector<std::byte>> read(std::uint32_t slot) override;
    [[nodiscard]] std::optional<Error> lost() override;
    [[nodiscard]] Result<std::uint64_t> descriptorsElsewhere() override;

  private:
    SluiceRendererCapabilities capabilities_{};
    std::size_t texel_bytes_ = 0;
    std::uint64_t last_signal_ = 0;
    std::unique_ptr<SharedTimeline> timeline_;  ///< this and the next change only while nobody waits
    std::unique_ptr<SharedTimeline> relay_;     ///< of threads of this process alone
    VulkanProcess process_;                     ///< dies first: its end is told to the two
};

Status VkElsewhere::start(const SluiceHostCapabilities& host) {
    if (Status started = process_.start(); !started) {
        return started;
    }
    Request request;
    request.call = Call::Open;
    request.host = host;
    const auto opened = process_.call(request, {}, 0, "opening the device");
    if (!opened) {
        return opened.error();
    }
    capabilities_ = opened.value().answer.renderer;
    return {};
}

Status VkElsewhere::allocate(const Storage& storage) {
    auto timeline = SharedTimeline::create();
    auto relay = SharedTimeline::create();
    if (!timeline || !relay) {
        return timeline ? relay.error() : timeline.error();
    }
    const std::optional<Error> end = process_.endsWaitsFor({timeline.value().get(), relay.value().get()});
    timeline_ = std::move(timeline).value();
    relay_ = std::move(relay).value();
    if (end) {
        return *end;  // nobody would tell the new ones
    }
    last_signal_ = 0;
    texel_bytes_ = std::size_t{storage.texels()} * 4;
    Request request;
    request.call = Call::Allocate;
    request.storage = storage;
    const int page = timeline_->fd();
    const auto done = process_.call(request, std::span(&page, 1), 0, "making resources");
    return done ? Status{} : Status{done.error()};
}

Result<ExportedSlot> VkElsewhere::exportSlot(std::uint32_t slot) {
    Request request;
    request.call = Call::Export;
    request.slot = slot;
    auto done = process_.call(request, {}, 1, fmt::format("export of slot {}", slot));
    if (!done) {
        return done.error();
    }
    return ExportedSlot{std::move(done.value().fds.front()), done.value().answer.count};
}

Status VkElsewhere::submit(const Turn& turn, const Hand& hand) {
    Request request;
    request.call = Call::Submit;
    request.turn.input_count = static_cast<std::uint32_t>(turn.inputs.size());
    for (std::size_t j = 0; j < turn.inputs.size(); ++j) {
        request.turn.inputs.at(j) = turn.inputs[j];
    }
    request.turn.output = turn.output;
    request.turn.salt = turn.salt;
    request.hand = hand;
    const auto done = process_.call(request, {}, 0, fmt::format("turn {}", turn.version));
    if (!done) {
        return done.error();
    }
    last_signal_ = hand.signal != 0 ? hand.signal : last_signal_;
    return {};
}

bool VkElsewhere::drain(std::uint64_t timeout_ns) {
    return timeline_ == nullptr || wait(last_signal_, timeout_ns) == SLUICE_OK || lost().has_value();
}

Result<std::vector<std::byte>> VkElsewhere::read(std::uint32_t slot) {
    Request request;
    request.call = Call::Read;
    request.slot = slot;
    const auto done = process_.call(request, {}, 1, fmt::format("read-back of slot {}", slot));
    if (!done) {
        return done.error();
    }
    const Result<isolate::Mapping> texels = isolate::mapSealed(done.value().fds.front(), texel_bytes_);
    if (!texels) {
        return texels.error();
    }
    const std::span<const std::byte> bytes = texels.value().bytes();
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

std::optional<Error> VkElsewhere::lost() {
    std::optional<Error> end = process_.ended();
    if (!end && timeline_ != nullptr && timeline_->failure() != SLUICE_OK) {
        return Error{timeline_->failure(), process_.name(), "its device could not be signalled or waited for",
                     "the same command may be run again"};
    }
    return end;
}

Result<std::uint64_t> VkElsewhere::descriptorsElsewhere() {
    Request request;
    request.call = Call::Descriptors;
    const auto done = process_.call(request, {}, 0, "counting its descriptors");
    if (!done) {
        return done.error();
    }
    return done.value().answer.count;
}

}  // namespace

Result<std::unique_ptr<VkSide>> startVkProcess(const SluiceHostCapabilities& host) {
    auto side = std::make_unique<VkElsewhere>();
    if (Status status = side->start(host); !status) {
        return status.error();
    }
    return std::unique_ptr<VkSide>(std::move(side));
}

}  // namespace sluice::stress
