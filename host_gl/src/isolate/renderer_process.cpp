// SPDX-License-Identifier: MIT
#include "isolate/renderer_process.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>
#include <variant>

#include "sluice/abi_sizes.hpp"
#include "sluice/blocked_signals.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

namespace {

constexpr std::uint64_t kShortestCallNs = 1'000'000;
constexpr std::uint64_t kLongestCallNs = 86'400'000'000'000;
/// To load a plugin and say what it is.
constexpr std::uint64_t kStartNs = 60'000'000'000;
/// The end of a renderer waits for its frames in flight.
constexpr std::uint64_t kDestroyNs = 10'000'000'000;
/// How often IsolationConfig::hurry is asked, and how long a call may take after it has said yes.
constexpr std::uint64_t kHurrySliceNs = 200'000'000;
constexpr std::uint64_t kHurriedNs = 2'000'000'000;
/// A process that ends closes its channel's two directions one right after the other.
constexpr std::uint64_t kClosingNs = 1'000'000'000;
/// Longer than a process can take to end or be left behind. Past it, the thread that listens is held up in a callback.
constexpr std::chrono::seconds kEndWait{30};

double seconds(std::uint64_t nanoseconds) {
    return static_cast<double>(nanoseconds) * 1e-9;
}

std::uint64_t until(std::uint64_t deadline_ns) {
    return deadline_ns - std::min(deadline_ns, monotonicNanoseconds());
}

}  // namespace

CallLimits limitsOf(const IsolationConfig& config) {
    CallLimits limits;
    limits.call_ns = std::clamp(config.call_timeout_ns, kShortestCallNs, kLongestCallNs);
    const std::uint64_t frame = config.frame_call_timeout_ns != 0 ? config.frame_call_timeout_ns : limits.call_ns;
    limits.frame_call_ns = std::clamp(frame, kShortestCallNs, limits.call_ns);
    return limits;
}

Result<std::unique_ptr<RendererProcess>> RendererProcess::start(const IsolationConfig& config,
                                                                const isolate::Hello& hello, ChildWatch watch) {
    std::unique_ptr<RendererProcess> process(new RendererProcess(config, hello, std::move(watch)));
    const CallLimits limits = limitsOf(config);
    process->config_.call_timeout_ns = limits.call_ns;
    process->config_.frame_call_timeout_ns = limits.frame_call_ns;
    const std::uint64_t timeout = std::min(limits.call_ns, kStartNs);
    Result<std::unique_ptr<isolate::SharedTimeline>> timeline = isolate::SharedTimeline::create();
    if (!timeline) {
        return timeline.error();
    }
    process->timeline_ = std::move(timeline).value();
    {
        Result<std::pair<isolate::Channel, isolate::Channel>> ends = isolate::Channel::pair();
        if (!ends) {
            return ends.error();
        }
        process->channel_ = std::move(ends.value().first);
        // The kernel ends the process with the thread that starts it, and this thread may be the first to end.
        try {
            const BlockedSignals quiet;
            process->listener_ =
                std::thread([raw = process.get(), there = &ends.value().second] { raw->live(*there); });
        } catch (const std::system_error& failed) {
            return Error{SLUICE_ERROR_OUT_OF_MEMORY, "thread of the renderer process", failed.what(), ""};
        }
        if (Status started = process->spawned(); !started) {
            return started.error();
        }
    }
    const std::uint64_t deadline = monotonicNanoseconds() + timeout;
    const int page = process->timeline_->fd();
    Status sent = process->channel_.send(hello, 0, std::span(&page, 1), timeout);
    if (!sent && sent.error().code != SLUICE_ERROR_DEVICE_LOST) {
        return sent.error();  // nobody will answer what was never sent
    }
    // A process that ended before it listened tells more by its end than by the failed send.
    Result<isolate::Received> answer = process->nextMessage(deadline, timeout);
    if (!answer) {
        Error error = answer.error();
        error.thing = fmt::format("renderer plugin '{}'", config.plugin.string());
        error.code = SLUICE_ERROR_UNSUPPORTED;
        error.remedy = "what it said stands above; --plugin names another, and without isolation there is no process";
        return error;
    }
    if (!sent) {
        return sent.error();
    }
    const auto* welcome = std::get_if<isolate::Welcome>(&answer.value().message);
    if (welcome == nullptr || welcome->abi_version >> 16U != SLUICE_ABI_MAJOR) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, "renderer process", "it does not serve this ABI", kRecreate};
    }
    process->welcome_ = *welcome;
    return process;
}

Status RendererProcess::spawned() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return spawned_.has_value(); });
    return *spawned_;
}

RendererProcess::~RendererProcess() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    channel_.shutdown();
    if (listener_.joinable()) {
        listener_.join();
    }
}

void RendererProcess::limitCalls(std::uint64_t call_timeout_ns) {
    const std::scoped_lock lock(call_mutex_, mutex_);
    config_.call_timeout_ns = std::clamp(call_timeout_ns, kShortestCallNs, kLongestCallNs);
    config_.frame_call_timeout_ns = config_.call_timeout_ns;
}

std::uint64_t RendererProcess::limitOf(const isolate::Message& message) const {
    const bool of_frame =
        std::holds_alternative<isolate::SubmitFrame>(message) || std::holds_alternative<isolate::Poll>(message) ||
        std::holds_alternative<isolate::TimelineValue>(message) ||
        std::holds_alternative<isolate::TimelineExport>(message) ||
        std::holds_alternative<isolate::Simulate>(message) ||
        std::holds_alternative<isolate::SimulationStats>(message) ||
        std::holds_alternative<isolate::SimulationBodies>(message) ||
        std::holds_alternative<isolate::SetBody>(message) || std::holds_alternative<isolate::SetFlow>(message) ||
        std::holds_alternative<isolate::ResetSimulation>(message);
    if (of_frame) {
        return config_.frame_call_timeout_ns;
    }
    // A renderer that holds up frames does not end either.
    return std::holds_alternative<isolate::Destroy>(message)
               ? std::min(config_.call_timeout_ns, std::max(config_.frame_call_timeout_ns, kDestroyNs))
               : config_.call_timeout_ns;
}

bool RendererProcess::alive() {
    {
        const std::lock_guard lock(mutex_);
        if (end_ || !blame_.empty()) {
            return false;
        }
    }
    pollfd ended{child_.endFd(), POLLIN, 0};
    return ended.fd < 0 || ::poll(&ended, 1, 0) == 0;
}

void RendererProcess::passTo(const SluiceHostServices* services) {
    const std::lock_guard lock(services_mutex_);
    services_ = services != nullptr ? std::optional(readAbiStruct(*services)) : std::nullopt;
}

void RendererProcess::condemn(std::string blame) {
    {
        const std::lock_guard lock(mutex_);
        if (blame_.empty()) {
            blame_ = std::move(blame);
        }
    }
    child_.kill();
    channel_.shutdown();  // SIGKILL may not end it, and the listener shall hear of it all the same
}

Error RendererProcess::gone() {
    std::unique_lock lock(mutex_);
    // Whoever condemned it waits here until it is so.
    if (!changed_.wait_for(lock, kEndWait, [this] { return end_.has_value(); })) {
        return {SLUICE_ERROR_DEVICE_LOST, fmt::format("renderer process {}", child_.pid()),
                (blame_.empty() ? "has closed its channel" : blame_) +
                    "; its end is not known, for the host's log or trace callback has not returned",
                kRecreate};
    }
    changed_.wait_for(lock, std::chrono::nanoseconds(child_.watch().telling_ns), [this] { return !telling_; });
    Error error = *end_;
    if (told_) {
        error.detail = "is gone; the log says how";
        error.remedy.clear();
    }
    return error;
}

Result<isolate::Received> RendererProcess::nextMessage(std::uint64_t deadline_ns, std::uint64_t limit_ns) {
    std::unique_lock lock(mutex_);
    bool came = false;
    bool hurried = false;
    do {
        const std::uint64_t left = until(deadline_ns);
        came = changed_.wait_for(lock, std::chrono::nanoseconds(config_.hurry ? std::min(left, kHurrySliceNs) : left),
                                 [this] { return !mail_.empty() || end_.has_value(); });
        if (!came && !hurried && config_.hurry && config_.hurry() && until(deadline_ns) > kHurriedNs) {
            hurried = true;
            deadline_ns = monotonicNanoseconds() + kHurriedNs;
        }
    } while (!came && until(deadline_ns) != 0);
    if (!came && closed_) {
        lock.unlock();
        return gone();
    }
    if (!came) {
        const std::string doing = doing_;
        lock.unlock();
        condemn(fmt::format("did not answer {} within {:.3f} s{} and was killed", doing,
                            seconds(hurried ? kHurriedNs : limit_ns), hurried ? " of the interruption" : ""));
        return gone();
    }
    if (mail_.empty()) {
        lock.unlock();
        return gone();
    }
    isolate::Received received = std::move(mail_.front());
    mail_.pop_front();
    lines_ -= std::holds_alternative<isolate::Line>(received.message) ? 1U : 0U;
    waiting_ = waiting_ && !std::holds_alternative<isolate::Returned>(received.message) &&
               !std::holds_alternative<isolate::Welcome>(received.message);
    return received;
}

Status RendererProcess::deliver(const isolate::Message& message, std::uint64_t number, std::span<const int> fds,
                                const std::string& what, std::uint64_t deadline_ns) {
    Status sent = channel_.send(message, number, fds, until(deadline_ns));
    if (sent) {
        return {};
    }
    if (sent.error().code == SLUICE_TIMEOUT) {
        condemn(fmt::format("did not take {} within {:.3f} s and was killed", what, seconds(limitOf(message))));
    } else if (sent.error().code != SLUICE_ERROR_DEVICE_LOST) {
        return sent;
    } else if (!channel_.closedThere(kClosingNs)) {
        condemn(fmt::format("would not take {}, though it lives, and was killed", what));
    }
    return gone();
}

Result<Reply> RendererProcess::call(const isolate::Message& message, std::span<const int> fds, std::string doing,
                                    const CallBacks& back) {
    const std::lock_guard one_call(call_mutex_);
    {
        const std::lock_guard lock(mutex_);
        if (!end_) {
            doing_ = doing;
        }
        waiting_ = true;
    }
    const std::uint64_t number = ++calls_;
    const std::uint64_t limit = limitOf(message);
    std::uint64_t deadline = monotonicNanoseconds() + limit;
    if (Status sent = deliver(message, number, fds, doing, deadline); !sent) {
        return sent.error();
    }
    for (std::uint32_t served = 0; served <= kMostCallbacks; ++served) {
        Result<isolate::Received> received = nextMessage(deadline, limit);
        if (!received) {
            return received.error();
        }
        isolate::Received& got = received.value();
        const std::uint64_t begin = monotonicNanoseconds();
        if (const auto* line = std::get_if<isolate::Line>(&got.message); line != nullptr && back.sink != nullptr) {
            back.sink(back.sink_user, line->text.c_str());
            deadline += monotonicNanoseconds() - begin;
            continue;
        }
        if (got.call != number) {
            condemn(fmt::format("answered call {} during {} (call {}) and was killed", got.call, doing, number));
            return gone();
        }
        if (auto* returned = std::get_if<isolate::Returned>(&got.message)) {
            const std::lock_guard lock(mutex_);
            doing_ = "after " + std::move(doing);
            return Reply{std::move(*returned), std::move(got.fds)};
        }
        const isolate::Answer answer = answerTo(got, back);
        deadline += monotonicNanoseconds() - begin;
        if (Status sent = deliver(answer, number, {}, "its answer during " + doing, deadline); !sent) {
            if (sent.error().code != SLUICE_ERROR_DEVICE_LOST) {  // it waits for that answer, and nothing would end it
                condemn(fmt::format("could not be answered during {} and was killed: {}", doing, sent.error().detail));
                return gone();
            }
            return sent.error();
        }
    }
    condemn(fmt::format("called back more than {} times during {} and was killed", kMostCallbacks, doing));
    return gone();
}

isolate::Answer RendererProcess::answerTo(isolate::Received& asked, const CallBacks& back) const {
    auto error = sized<SluiceError>();
    SluiceResult result = SLUICE_OK;
    auto* share = std::get_if<isolate::ShareImage>(&asked.message);
    auto* canary = std::get_if<isolate::Canary>(&asked.message);
    const auto* retire = std::get_if<isolate::RetireImage>(&asked.message);
    const SluiceHostServices* services = back.services;
    if (share != nullptr && services != nullptr && services->share_image != nullptr) {
        share->image.fd = asked.fds.at(0).get();
        result = services->share_image(services->user, &share->image, &error);
    } else if (canary != nullptr && services != nullptr && services->canary != nullptr) {
        canary->image.fd = asked.fds.at(0).get();
        result = services->canary(services->user, &canary->image, canary->seed, &error);
    } else if (retire != nullptr && services != nullptr && services->retire_image != nullptr) {
        services->retire_image(services->user, retire->role, retire->image_set);
    } else {
        return {{},
                SLUICE_ERROR_INVALID_ARGUMENT,
                fmt::format("the host offers no {} during this call", nameOf(asked.message))};
    }
    if (result == SLUICE_OK && !asked.fds.empty()) {
        static_cast<void>(asked.fds.at(0).release());  // the host's now
    }
    return {{}, result, &error.message[0]};
}

}  // namespace sluice::host
