// SPDX-License-Identifier: MIT
#include "isolate/host_end.hpp"

#include <cstring>
#include <utility>

#include "sluice/abi_boundary.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/export_mark.hpp"
#include "sluice/fd.hpp"

namespace sluice::isolate {

Error breachOfHost(std::string detail) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, "host of this renderer", std::move(detail), "the host is broken"};
}

SluiceHostServices HostEnd::services(std::uint32_t wants_trace) {
    auto services = sized<SluiceHostServices>();
    services.abi_version = SLUICE_ABI_VERSION;
    services.user = this;
    services.log = [](void* user, std::int32_t level, const char* message) {
        (void)guarded(nullptr, [&]() -> Status {
            static_cast<HostEnd*>(user)->tell(Log{{}, level, message != nullptr ? message : ""});
            return {};
        });
    };
    if (wants_trace != 0) {
        services.trace = [](void* user, const SluiceTraceEvent* event) {
            (void)guarded(nullptr, [&]() -> Status {
                static_cast<HostEnd*>(user)->trace(event);
                return {};
            });
        };
    }
    services.share_image = [](void* user, const SluiceImageExport* image, SluiceError* error) {
        return guarded(error, [&]() -> Status {
            if (Status status = checkAbiStruct(image, "image"); !status) {
                return status;
            }
            return static_cast<HostEnd*>(user)->give(*image, ShareImage{{}, readAbiStruct(*image)});
        });
    };
    services.retire_image = [](void* user, std::uint32_t role, std::uint32_t image_set) {
        (void)guarded(nullptr, [&]() -> Status {
            return static_cast<HostEnd*>(user)->ask(RetireImage{{}, role, image_set}, {});
        });
    };
    services.canary = [](void* user, const SluiceImageExport* image, std::uint32_t seed, SluiceError* error) {
        return guarded(error, [&]() -> Status {
            if (Status status = checkAbiStruct(image, "image"); !status) {
                return status;
            }
            return static_cast<HostEnd*>(user)->give(*image, Canary{{}, seed, readAbiStruct(*image)});
        });
    };
    return services;
}

Status HostEnd::ask(const Message& message, std::span<const int> fds) {
    flushTrace();  // the events of what is asked come before it
    if (Status sent = channel_.send(message, call_, fds, kSendNs); !sent) {
        return sent;
    }
    Result<Received> received = channel_.receive(kForever);
    if (!received) {
        return received.error();
    }
    const Answer* answer = std::get_if<Answer>(&received.value().message);
    if (answer == nullptr || received.value().call != call_) {
        breach_ = breachOfHost("it did not answer a " + std::string(nameOf(message)));
        return *breach_;
    }
    if (answer->result != SLUICE_OK) {
        return Error{static_cast<SluiceResult>(answer->result), {}, answer->message, {}};
    }
    return {};
}

Status HostEnd::give(const SluiceImageExport& image, const Message& message) {
    Status status = ask(message, std::span(&image.fd, 1));
    if (status) {
        const UniqueFd handed_over(image.fd);
    }
    return status;
}

void HostEnd::trace(const SluiceTraceEvent* event) {
    if (event == nullptr || event->struct_size < kAbiMinimum<SluiceTraceEvent>) {
        return;
    }
    const std::lock_guard lock(trace_mutex_);
    TracePoint& point = trace_.events.emplace_back();
    point.kind = event->kind;
    point.track = event->track;
    point.direction = event->direction;
    point.begin_ns = event->begin_ns;
    point.duration_ns = event->duration_ns;
    point.frame = event->frame;
    point.value = valueElsewhere(*event);
    point.bytes = event->bytes;
    if (event->name != nullptr) {
        std::memcpy(point.name.data(), event->name, strnlen(event->name, point.name.size() - 1));
    }
    if (trace_.events.size() == kMaxTraceEvents) {
        sendTrace();
    }
}

void HostEnd::flushTrace() {
    const std::lock_guard lock(trace_mutex_);
    if (!trace_.events.empty()) {
        sendTrace();
    }
}

void HostEnd::sendTrace() {
    tell(trace_);
    trace_.events.clear();
}

}  // namespace sluice::isolate
