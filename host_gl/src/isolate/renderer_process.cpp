// SPDX-License-Identifier: MIT
#include "isolate/renderer_process.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>
#include <variant>

#include "sluice/abi_sizes.hpp"

namespace sluice::host {

namespace {

constexpr const char* kRemedy = "destroy the renderer and create it again";
/// For a process that has closed its channel, or was asked to end: to run its exit handlers.
constexpr std::uint64_t kGraceNs = 10'000'000'000;

double seconds(std::uint64_t nanoseconds) {
    return static_cast<double>(nanoseconds) * 1e-9;
}

}  // namespace

Result<std::unique_ptr<RendererProcess>> RendererProcess::start(const IsolationConfig& config,
                                                                const isolate::Hello& hello) {
    std::unique_ptr<RendererProcess> process(new RendererProcess(config, hello));
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
        // dlopen searches the library path for a name without a slash.
        std::error_code ignored;
        const std::string plugin = std::filesystem::absolute(config.plugin, ignored).string();
        if (Status started = process->child_.start(config.program, plugin, ends.value().second); !started) {
            return started.error();
        }
    }
    process->listener_ = std::thread([raw = process.get()] { raw->listen(); });
    const int page = process->timeline_->fd();
    Status sent = process->channel_.send(hello, 0, std::span(&page, 1), config.call_timeout_ns);
    // A process that ended before it listened tells more by its end than by the failed send.
    Result<isolate::Received> answer = process->nextMessage();
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
        return Error{SLUICE_ERROR_ABI_MISMATCH, "renderer process", "it does not serve this ABI", kRemedy};
    }
    process->welcome_ = *welcome;
    return process;
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

void RendererProcess::passTo(const SluiceHostServices* services) {
    const std::lock_guard lock(services_mutex_);
    services_ = services != nullptr ? std::optional(readAbiStruct(*services)) : std::nullopt;
}

bool RendererProcess::log(std::int32_t level, const std::string& text) {
    const std::lock_guard lock(services_mutex_);
    if (!services_ || services_->log == nullptr) {
        return false;
    }
    services_->log(services_->user, level, text.c_str());
    return true;
}

void RendererProcess::listen() {
    for (;;) {
        std::array<pollfd, 2> watched{{{channel_.fd(), POLLIN, 0}, {child_.endFd(), POLLIN, 0}}};
        static_cast<void>(::poll(watched.data(), watched.size(), -1));
        Result<isolate::Received> received = channel_.receive(0);
        if (received) {
            hear(std::move(received).value());
            continue;
        }
        // What was sent before the end has been heard by now.
        if (received.error().code == SLUICE_TIMEOUT) {
            if (watched[1].revents != 0) {
                break;
            }
            continue;
        }
        if (received.error().code != SLUICE_ERROR_DEVICE_LOST) {
            condemn("sent what is no message and was killed: " + received.error().message());
        }
        break;
    }
    noteEnd();
}

void RendererProcess::hear(isolate::Received received) {
    if (const auto* line = std::get_if<isolate::Log>(&received.message)) {
        static_cast<void>(log(line->level, line->text));
        return;
    }
    if (const auto* trace = std::get_if<isolate::TraceEvents>(&received.message)) {
        const std::lock_guard lock(services_mutex_);
        if (!services_ || services_->trace == nullptr) {
            return;
        }
        for (const isolate::TracePoint& point : trace->events) {
            auto event = sized<SluiceTraceEvent>();
            event.kind = point.kind;
            event.track = point.track;
            event.direction = point.direction;
            event.begin_ns = point.begin_ns;
            event.duration_ns = point.duration_ns;
            event.frame = point.frame;
            event.value = point.value;
            event.bytes = point.bytes;
            event.name = point.name.data();
            services_->trace(services_->user, &event);
        }
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        mail_.push_back(std::move(received));
    }
    changed_.notify_all();
}

void RendererProcess::noteEnd() {
    bool clean = false;
    const std::string how = child_.reap(kGraceNs, clean);
    Error end{SLUICE_ERROR_DEVICE_LOST, fmt::format("renderer process {}", child_.pid()), {}, kRemedy};
    bool asked = false;
    {
        const std::lock_guard lock(mutex_);
        asked = ending_;
        end.detail = !blame_.empty() ? blame_
                                     : fmt::format("{} {} {}", how,
                                                   doing_.starts_with("after") ? "between calls," : "during", doing_);
    }
    if (!asked) {
        // Not left to whoever calls next: many calls can say no more than a code.
        told_ = log(SLUICE_LOG_ERROR, end.message());
    } else if (!clean) {
        static_cast<void>(log(SLUICE_LOG_WARNING, fmt::format("{} {} when it was to end", end.thing, how)));
    }
    {
        const std::lock_guard lock(mutex_);
        end_ = std::move(end);
    }
    timeline_->peerDied();
    changed_.notify_all();
}

void RendererProcess::condemn(std::string blame) {
    {
        const std::lock_guard lock(mutex_);
        if (blame_.empty()) {
            blame_ = std::move(blame);
        }
    }
    child_.kill();
}

Error RendererProcess::gone() {
    std::unique_lock lock(mutex_);
    // Whoever condemned it waits here until it is so; the listener always gets there.
    changed_.wait(lock, [this] { return end_.has_value(); });
    Error error = *end_;
    if (told_) {
        error.detail = "is gone; the log says how";
    }
    return error;
}

Result<isolate::Received> RendererProcess::nextMessage() {
    std::unique_lock lock(mutex_);
    const bool came = changed_.wait_for(lock, std::chrono::nanoseconds(config_.call_timeout_ns),
                                        [this] { return !mail_.empty() || end_.has_value(); });
    if (!came) {
        const std::string doing = doing_;
        lock.unlock();
        condemn(
            fmt::format("did not answer {} within {:.3f} s and was killed", doing, seconds(config_.call_timeout_ns)));
        return gone();
    }
    if (mail_.empty()) {
        lock.unlock();
        return gone();
    }
    isolate::Received received = std::move(mail_.front());
    mail_.pop_front();
    return received;
}

Result<Reply> RendererProcess::call(const isolate::Message& message, std::span<const int> fds, std::string doing,
                                    const CallBacks& back) {
    const std::lock_guard one_call(call_mutex_);
    {
        const std::lock_guard lock(mutex_);
        if (!end_) {
            doing_ = doing;
        }
    }
    const std::uint64_t number = ++calls_;
    if (const Status sent = channel_.send(message, number, fds, config_.call_timeout_ns); !sent) {
        if (sent.error().code == SLUICE_TIMEOUT) {
            condemn(
                fmt::format("did not take {} within {:.3f} s and was killed", doing, seconds(config_.call_timeout_ns)));
        } else if (sent.error().code != SLUICE_ERROR_DEVICE_LOST) {
            return sent.error();
        }
        return gone();
    }
    for (;;) {
        Result<isolate::Received> received = nextMessage();
        if (!received) {
            return received.error();
        }
        isolate::Received& got = received.value();
        if (const auto* line = std::get_if<isolate::Line>(&got.message); line != nullptr && back.sink != nullptr) {
            back.sink(back.sink_user, line->text.c_str());
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
        if (const Status sent = channel_.send(answer, number, {}, config_.call_timeout_ns); !sent) {
            if (sent.error().code != SLUICE_ERROR_DEVICE_LOST) {  // it lives, and nothing else would end it
                condemn(fmt::format("did not take its answer during {} and was killed", doing));
            }
            return gone();
        }
    }
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
