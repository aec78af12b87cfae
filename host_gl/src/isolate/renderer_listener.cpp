// SPDX-License-Identifier: MIT
// What the thread of a RendererProcess does: it starts the process, listens to it and tells its end.
#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>
#include <utility>
#include <variant>

#include "isolate/renderer_process.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host {

void RendererProcess::live(const isolate::Channel& there) {
    Status started;
    try {
        started = spawn(there);
    } catch (const std::exception&) {
        started = Error{SLUICE_ERROR_OUT_OF_MEMORY, {}, {}, {}};
    }
    const bool runs = started.ok();
    {
        const std::lock_guard lock(mutex_);
        spawned_ = std::move(started);
    }
    changed_.notify_all();  // from here on `there` may be gone
    if (!runs) {
        return;
    }
    const char* misfortune = nullptr;
    try {
        listen();
    } catch (const std::bad_alloc&) {
        misfortune = "was killed: this process found no memory to listen to it";
    } catch (...) {
        misfortune = "was killed: the log or trace of this process threw what it was to pass on";
    }
    noteEnd(misfortune);
}

Status RendererProcess::spawn(const isolate::Channel& there) {
    // dlopen searches the library path for a name without a slash.
    std::error_code ignored;
    const std::string plugin = std::filesystem::absolute(config_.plugin, ignored).string();
    if (Status started = child_.start(config_.program, plugin, there, config_.detached); !started) {
        return started;
    }
    last_words_ = Error{SLUICE_ERROR_DEVICE_LOST, fmt::format("renderer process {}", child_.pid()),
                        "is gone; there was no memory to say how", kRecreate};
    return {};
}

void RendererProcess::listen() {
    for (bool ended = false;;) {
        std::array<pollfd, 2> watched{{{channel_.fd(), POLLIN, 0}, {ended ? -1 : child_.endFd(), POLLIN, 0}}};
        static_cast<void>(::poll(watched.data(), watched.size(), -1));
        if (watched[1].revents != 0) {
            // What it sent lies here. Whoever else holds its end, a process of its own perhaps, is not heard.
            ended = true;
            channel_.shutdown();
        }
        Result<isolate::Received> received = channel_.receive(0);
        if (received) {
            hear(std::move(received).value());
            continue;
        }
        if (received.error().code == SLUICE_TIMEOUT) {
            continue;
        }
        if (received.error().code != SLUICE_ERROR_DEVICE_LOST) {
            condemn("sent what is no message and was killed: " + received.error().message());
        }
        return;
    }
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
    // A renderer waits for the answer to whatever it asks, and returns once a call: of all but lines there is one.
    const bool line = std::holds_alternative<isolate::Line>(received.message);
    const std::string_view name = isolate::nameOf(received.message);
    {
        const std::lock_guard lock(mutex_);
        if (line ? lines_ < kMostLines : waiting_ && mail_.size() == lines_) {
            lines_ += line ? 1U : 0U;
            mail_.push_back(std::move(received));
            changed_.notify_all();
            return;
        }
    }
    condemn(line ? fmt::format("sent more than {} lines that nobody had read yet and was killed", kMostLines)
                 : fmt::format("sent a {} that nobody had asked for and was killed", name));
}

void RendererProcess::noteEnd(const char* misfortune) {
    if (misfortune != nullptr) {
        child_.kill();
    }
    // It may live on with nothing but its sending end closed: it shall not be asked, nor waited for, any more.
    channel_.shutdown();
    timeline_->peerDied();
    std::uint64_t grace = child_.watch().grace_ns;
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        if (misfortune != nullptr || !blame_.empty()) {
            grace = 0;
        } else if (!ending_) {
            grace = std::min(grace, config_.call_timeout_ns);  // a call may be waiting for this
        }
    }
    const ChildEnd ended = child_.reap(grace);
    std::int32_t level = SLUICE_LOG_ERROR;
    std::string line;
    try {
        Error end = endOf(ended, misfortune, level, line);
        const std::lock_guard lock(mutex_);
        telling_ = !line.empty();
        end_ = std::move(end);
    } catch (...) {
        const std::lock_guard lock(mutex_);
        end_.emplace(std::move(last_words_));
    }
    changed_.notify_all();  // whatever the log does now, nobody hangs here for it
    bool told = false;
    try {
        // Not left to whoever calls next: many calls can say no more than a code.
        told = !line.empty() && log(level, line);
    } catch (...) {  // then the next call does say it
    }
    {
        const std::lock_guard lock(mutex_);
        told_ = told;
        telling_ = false;
    }
    changed_.notify_all();
}

Error RendererProcess::endOf(const ChildEnd& ended, const char* misfortune, std::int32_t& level, std::string& line) {
    const std::string how = ended.text();
    Error end{SLUICE_ERROR_DEVICE_LOST, fmt::format("renderer process {}", child_.pid()), {}, {}};
    const std::lock_guard lock(mutex_);
    blame_ = blame_.empty() && misfortune != nullptr ? misfortune : blame_;
    if (!blame_.empty()) {
        end.detail = ended.kind == ChildEnd::Kind::Stuck ? blame_ + ", but " + how : blame_;
    } else {
        end.detail = fmt::format("{}{} {} {}", ended.late() ? "closed its channel, " : "", how,
                                 doing_.starts_with("after") ? "between calls," : "during", doing_);
    }
    if (!ending_) {
        line = end.message();  // what follows is the reader's to say
    } else if (!ended.clean()) {
        level = SLUICE_LOG_WARNING;
        line = fmt::format("{} {} when it was to end", end.thing, how);
    }
    end.remedy = kRecreate;
    return end;
}

bool RendererProcess::log(std::int32_t level, const std::string& text) {
    const std::lock_guard lock(services_mutex_);
    if (!services_ || services_->log == nullptr) {
        return false;
    }
    services_->log(services_->user, level, text.c_str());
    return true;
}

}  // namespace sluice::host
