// SPDX-License-Identifier: MIT
#include "stress/process/vulkan_process.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

namespace sluice::stress {
namespace {

constexpr std::uint64_t kCallSeconds = 30;  ///< far more than any wait inside a call
constexpr std::uint64_t kCallNs = kCallSeconds * 1'000'000'000;
constexpr std::uint64_t kClosingNs = 1'000'000'000;  ///< between the two directions of a channel whose process ends

}  // namespace

VulkanProcess::~VulkanProcess() {
    channel_.shutdown();
    if (watcher_.joinable()) {
        watcher_.join();
    }
}

Status VulkanProcess::start() {
    std::error_code ignored;
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / kVulkanProgram;
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
    watcher_ = std::thread([this] { watch(); });
    return {};
}

std::string VulkanProcess::name() const {
    return fmt::format("Vulkan process {}", child_.pid());
}

std::optional<Error> VulkanProcess::endsWaitsFor(std::vector<isolate::SharedTimeline*> timelines) {
    const std::lock_guard lock(mutex_);
    waited_for_ = std::move(timelines);
    return end_;
}

std::optional<Error> VulkanProcess::ended() {
    const std::lock_guard lock(mutex_);
    return end_;
}

void VulkanProcess::watch() {
    // Without a request the end of the channel is told all the same; what came before it is read by call().
    std::array<pollfd, 2> watched{{{channel_.fd(), 0, 0}, {child_.endFd(), POLLIN, 0}}};
    while (::poll(watched.data(), watched.size(), -1) < 0) {
    }
    bool condemned = false;
    {
        const std::lock_guard lock(mutex_);
        condemned = !blame_.empty();
    }
    const host::ChildEnd ended = child_.reap(condemned ? 0 : child_.watch().grace_ns);
    const std::string how = (ended.late() ? "closed its channel, " : "") + ended.text();
    {
        const std::lock_guard lock(mutex_);
        const std::string blame = ended.kind == host::ChildEnd::Kind::Stuck ? blame_ + ", but " + how : blame_;
        end_ = Error{SLUICE_ERROR_DEVICE_LOST, name(),
                     blame_.empty() ? fmt::format("{} during {} or after it", how, doing_) : blame,
                     "what it said, if anything, stands above; the same command may be run again, and with --topology "
                     "bridge-thread there is no such process"};
        for (isolate::SharedTimeline* timeline : waited_for_) {
            timeline->peerDied();
        }
    }
    ended_.notify_all();
}

void VulkanProcess::condemn(std::string blame) {
    {
        const std::lock_guard lock(mutex_);
        blame_ = std::move(blame);
    }
    child_.kill();
    channel_.shutdown();  // wakes the watcher even if SIGKILL does not end the process
}

Error VulkanProcess::gone() {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return end_.has_value(); });
    return *end_;
}

Result<VulkanProcess::Reply> VulkanProcess::call(const Request& request, std::span<const int> fds, std::size_t fds_back,
                                                 const std::string& doing) {
    {
        const std::lock_guard lock(mutex_);
        doing_ = doing;
    }
    const Status sent = channel_.sendBytes(bytesOf(request), fds, kCallNs);
    Result<isolate::Packet> came = sent ? channel_.receiveBytes(kCallNs) : Result<isolate::Packet>(Error(sent.error()));
    if (!came && came.error().code == SLUICE_ERROR_DEVICE_LOST) {
        if (!channel_.closedThere(kClosingNs)) {
            condemn(fmt::format("would not {} {}, though it lives, and was killed", sent ? "answer" : "take", doing));
        }
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

}  // namespace sluice::stress
