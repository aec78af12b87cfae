// SPDX-License-Identifier: MIT
#include "stress/process/worker.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "sluice/isolate/sealed_memory.hpp"
#include "stress/descriptors.hpp"
#include "stress/process/carry.hpp"
#include "stress/process/messages.hpp"
#include "stress/vk/side.hpp"

namespace sluice::stress {
namespace {

constexpr std::uint64_t kSendNs = 10'000'000'000;

Error breach(const char* what) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, "host", what, "host and process must be of one build"};
}

/// Cut if it is too long; what lies behind it is zero.
template <std::size_t N>
void put(std::array<char, N>& out, const std::string& text) {
    std::copy_n(text.begin(), std::min(text.size(), N - 1), out.begin());
}

Answer answerOf(const Error& error) {
    Answer answer;
    answer.code = error.code;
    put(answer.thing, error.thing);
    put(answer.detail, error.detail);
    put(answer.remedy, error.remedy);
    return answer;
}
Answer answerOf(const Status& status) {
    return status ? Answer{} : answerOf(status.error());
}

class Worker {
  public:
    explicit Worker(const isolate::Channel& channel) : channel_(channel) {}
    [[nodiscard]] Status run();

  private:
    /// `with` goes with the answer.
    [[nodiscard]] Answer handle(const Request& request, std::vector<UniqueFd>& came, UniqueFd& with);
    [[nodiscard]] Answer open(const SluiceHostCapabilities& host);
    [[nodiscard]] Answer allocate(const Storage& storage, std::vector<UniqueFd>& came);
    [[nodiscard]] Answer exportSlot(std::uint32_t slot, UniqueFd& with);
    [[nodiscard]] Answer submit(const WireTurn& wire, const Hand& hand);
    [[nodiscard]] Answer read(std::uint32_t slot, UniqueFd& with);

    const isolate::Channel& channel_;
    std::unique_ptr<VkSide> side_;
    std::unique_ptr<isolate::SharedTimeline> timeline_;
    std::optional<Carry> carry_;
    std::uint32_t slots_ = 0;
};

Status Worker::run() {
    for (;;) {
        Result<isolate::Packet> packet = channel_.receiveBytes(isolate::kForever);
        if (!packet) {
            return packet.error().code == SLUICE_ERROR_DEVICE_LOST ? Status{} : Status{packet.error()};
        }
        const std::optional<Request> request = messageIn<Request>(packet.value().bytes);
        if (!request) {
            return breach("it sent a message of another length");
        }
        UniqueFd with;
        const Answer answer = handle(*request, packet.value().fds, with);
        const int fd = with.get();
        const Status sent = channel_.sendBytes(bytesOf(answer),
                                               std::span(&fd, with.valid() ? std::size_t{1} : std::size_t{0}), kSendNs);
        if (!sent) {
            return sent.error().code == SLUICE_ERROR_DEVICE_LOST ? Status{} : sent;
        }
    }
}

Answer Worker::handle(const Request& request, std::vector<UniqueFd>& came, UniqueFd& with) {
    if (side_ == nullptr && request.call != Call::Open) {
        return answerOf(breach("it has not opened a device"));
    }
    switch (request.call) {
        case Call::Open:
            return open(request.host);
        case Call::Allocate:
            return allocate(request.storage, came);
        case Call::Export:
            return exportSlot(request.slot, with);
        case Call::Submit:
            return submit(request.turn, request.hand);
        case Call::Read:
            return read(request.slot, with);
        case Call::Descriptors: {
            Answer answer;
            answer.count = openDescriptors();
            return answer;
        }
    }
    return answerOf(breach("it asked for what is no call"));
}

Answer Worker::open(const SluiceHostCapabilities& host) {
    if (side_ != nullptr) {
        return answerOf(breach("it asked for a second device"));
    }
    Result<std::unique_ptr<VkSide>> side = VkSide::create(host);
    if (!side) {
        return answerOf(side.error());
    }
    side_ = std::move(side).value();
    Answer answer;
    answer.renderer = side_->capabilities();
    return answer;
}

Answer Worker::allocate(const Storage& storage, std::vector<UniqueFd>& came) {
    if (came.size() != 1) {
        return answerOf(breach("it sent no memory for the timelines"));
    }
    carry_.reset();
    slots_ = 0;
    auto timeline = isolate::SharedTimeline::adopt(std::move(came.front()));
    if (!timeline) {
        return answerOf(timeline.error());
    }
    timeline_ = std::move(timeline).value();
    if (const Status status = side_->allocate(storage); !status) {
        return answerOf(status);
    }
    slots_ = storage.slots.count();
    carry_.emplace(*side_, *timeline_);
    return {};
}

Answer Worker::exportSlot(std::uint32_t slot, UniqueFd& with) {
    if (slot >= slots_) {
        return answerOf(breach("it named a slot that is not there"));
    }
    Result<ExportedSlot> exported = side_->exportSlot(slot);
    if (!exported) {
        return answerOf(exported.error());
    }
    with = std::move(exported.value().fd);
    Answer answer;
    answer.count = exported.value().bytes;
    return answer;
}

Answer Worker::submit(const WireTurn& wire, const Hand& hand) {
    const auto known = [this](std::uint32_t slot) { return slot < slots_; };
    if (wire.input_count > kMaxInputs || !known(wire.output) ||
        !std::all_of(wire.inputs.begin(), wire.inputs.begin() + wire.input_count, known)) {
        return answerOf(breach("it named a slot that is not there"));
    }
    Turn turn;
    turn.inputs.assign(wire.inputs.begin(), wire.inputs.begin() + wire.input_count);
    turn.output = wire.output;
    turn.salt = wire.salt;
    const Status status = side_->submit(turn, hand);
    if (status && hand.signal != 0) {
        carry_->expect(hand.signal);
    }
    return answerOf(status);
}

Answer Worker::read(std::uint32_t slot, UniqueFd& with) {
    if (slot >= slots_) {
        return answerOf(breach("it named a slot that is not there"));
    }
    const Result<std::vector<std::byte>> texels = side_->read(slot);
    if (!texels) {
        return answerOf(texels.error());
    }
    Result<UniqueFd> memory = isolate::sealedCopy({texels.value()});
    if (!memory) {
        return answerOf(memory.error());
    }
    with = std::move(memory).value();
    return {};
}

}  // namespace

Status serveVulkan(const isolate::Channel& channel) {
    return Worker(channel).run();
}

}  // namespace sluice::stress
