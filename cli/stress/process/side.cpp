// SPDX-License-Identifier: MIT
#include "stress/process/side.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <array>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "isolate/child.hpp"
#include "sluice/isolate/channel.hpp"
#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/isolate/shared_timeline.hpp"
#include "stress/process/messages.hpp"

namespace sluice::stress {
namespace {

using isolate::SharedTimeline;
using isolate::WaitEnd;

constexpr std::uint64_t kCallSeconds = 30;  ///< far more than any wait inside a call
constexpr std::uint64_t kCallNs = kCallSeconds * 1'000'000'000;
constexpr std::uint64_t kGraceNs = 10'000'000'000;  ///< for a process that was asked to end

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
    ~VkElsewhere() override;
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
    struct Reply {
        Answer answer;
        std::vector<UniqueFd> fds;
    };
    /// `doing` is what is said if the process ends meanwhile.
    [[nodiscard]] Result<Reply> call(const Request& request, std::span<const int> fds, std::size_t fds_back,
                                     const std::string& doing);
    void watch();
    /// Kills it, for what only this process knows.
    void condemn(std::string blame);
    /// Blocks until the end is known.
    [[nodiscard]] Error gone();

    host::Child child_;
    isolate::Channel channel_;
    SluiceRendererCapabilities capabilities_{};
    std::size_t texel_bytes_ = 0;
    std::uint64_t last_signal_ = 0;

    std::mutex mutex_;  ///< of what follows; the pointers change only while nobody waits
    std::condition_variable ended_;
    std::unique_ptr<SharedTimeline> timeline_;
    std::unique_ptr<SharedTimeline> relay_;  ///< of threads of this process alone
    std::string doing_ = "its start";
    std::string blame_;
    std::optional<Error> end_;
    std::thread watcher_;
};

VkElsewhere::~VkElsewhere() {
    channel_.shutdown();
    if (watcher_.joinable()) {
        watcher_.join();
    }
}

Status VkElsewhere::start(const SluiceHostCapabilities& host) {
    std::error_code ignored;
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / kVulkanProgram;
    {
        auto ends = isolate::Channel::pair();
        if (!ends) {
            return ends.error();
        }
        channel_ = std::move(ends.value().first);
        if (const Status started = child_.start(program, "vulkan", ends.value().second); !started) {
            Error error = started.error();
            error.thing = fmt::format("Vulkan process '{}'", program.string());
            error.remedy = "it belongs beside the program; without it take --topology one-thread or bridge-thread";
            return error;
        }
    }
    watcher_ = std::thread([this] { watch(); });
    Request request;
    request.call = Call::Open;
    request.host = host;
    const Result<Reply> opened = call(request, {}, 0, "opening the device");
    if (!opened) {
        return opened.error();
    }
    capabilities_ = opened.value().answer.renderer;
    return {};
}

/// The end of the process is noticed whatever anybody waits for.
void VkElsewhere::watch() {
    // Without a request the end of the channel is told all the same; what came before it is read by call().
    std::array<pollfd, 2> watched{{{channel_.fd(), 0, 0}, {child_.endFd(), POLLIN, 0}}};
    while (::poll(watched.data(), watched.size(), -1) < 0) {
    }
    bool clean = false;
    const std::string how = child_.reap(kGraceNs, clean);
    {
        const std::lock_guard lock(mutex_);
        end_ = Error{SLUICE_ERROR_DEVICE_LOST, fmt::format("Vulkan process {}", child_.pid()),
                     blame_.empty() ? fmt::format("{} during {} or after it", how, doing_) : blame_,
                     "what it said, if anything, stands above; the same command may be run again, and with --topology "
                     "bridge-thread "
                     "there is no such process"};
        for (SharedTimeline* timeline : {timeline_.get(), relay_.get()}) {
            if (timeline != nullptr) {
                timeline->peerDied();
            }
        }
    }
    ended_.notify_all();
}

void VkElsewhere::condemn(std::string blame) {
    {
        const std::lock_guard lock(mutex_);
        blame_ = std::move(blame);
    }
    child_.kill();
}

Error VkElsewhere::gone() {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return end_.has_value(); });
    return *end_;
}

Result<VkElsewhere::Reply> VkElsewhere::call(const Request& request, std::span<const int> fds, std::size_t fds_back,
                                             const std::string& doing) {
    {
        const std::lock_guard lock(mutex_);
        doing_ = doing;
    }
    const Status sent = channel_.sendBytes(bytesOf(request), fds, kCallNs);
    Result<isolate::Packet> came = sent ? channel_.receiveBytes(kCallNs) : Result<isolate::Packet>(Error(sent.error()));
    if (!came && came.error().code == SLUICE_ERROR_DEVICE_LOST) {
        return gone();
    }
    if (!came) {
        condemn(came.error().code == SLUICE_TIMEOUT
                    ? fmt::format("did not answer {} within {} s and was killed", doing, kCallSeconds)
                    : "was killed: " + came.error().message());
        return gone();
    }
    const std::optional<Answer> answer = messageIn<Answer>(came.value().bytes);
    if (!answer) {
        condemn(fmt::format("sent {} bytes where {} were expected and was killed", came.value().bytes.size(),
                            sizeof(Answer)));
        return gone();
    }
    if (answer->code != SLUICE_OK) {
        return Error{static_cast<SluiceResult>(answer->code), answer->thing.data(), answer->detail.data(),
                     answer->remedy.data()};
    }
    if (came.value().fds.size() != fds_back) {
        condemn(fmt::format("sent {} descriptors where {} were expected and was killed", came.value().fds.size(),
                            fds_back));
        return gone();
    }
    return Reply{*answer, std::move(came.value().fds)};
}

Status VkElsewhere::allocate(const Storage& storage) {
    auto timeline = SharedTimeline::create();
    auto relay = SharedTimeline::create();
    if (!timeline || !relay) {
        return timeline ? relay.error() : timeline.error();
    }
    {
        const std::lock_guard lock(mutex_);
        timeline_ = std::move(timeline).value();
        relay_ = std::move(relay).value();
        if (end_) {
            return *end_;  // nobody would tell the new ones
        }
    }
    last_signal_ = 0;
    texel_bytes_ = std::size_t{storage.texels()} * 4;
    Request request;
    request.call = Call::Allocate;
    request.storage = storage;
    const int page = timeline_->fd();
    const Result<Reply> done = call(request, std::span(&page, 1), 0, "making resources");
    return done ? Status{} : Status{done.error()};
}

Result<ExportedSlot> VkElsewhere::exportSlot(std::uint32_t slot) {
    Request request;
    request.call = Call::Export;
    request.slot = slot;
    Result<Reply> done = call(request, {}, 1, fmt::format("export of slot {}", slot));
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
    const Result<Reply> done = call(request, {}, 0, fmt::format("turn {}", turn.version));
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
    const Result<Reply> done = call(request, {}, 1, fmt::format("read-back of slot {}", slot));
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
    const std::lock_guard lock(mutex_);
    if (!end_ && timeline_ != nullptr && timeline_->failure() != SLUICE_OK) {
        return Error{timeline_->failure(), fmt::format("Vulkan process {}", child_.pid()),
                     "its device could not be signalled or waited for", "the same command may be run again"};
    }
    return end_;
}

Result<std::uint64_t> VkElsewhere::descriptorsElsewhere() {
    Request request;
    request.call = Call::Descriptors;
    const Result<Reply> done = call(request, {}, 0, "counting its descriptors");
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
