// SPDX-License-Identifier: MIT
#include "isolate/call_server.hpp"

#include <span>

#include "sluice/abi_boundary.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::isolate {

Status Server::run() {
    for (;;) {
        Result<Received> received = channel_.receive(kForever);
        if (!received) {
            return received.error().code == SLUICE_ERROR_DEVICE_LOST ? Status{} : Status{received.error()};
        }
        call_ = received.value().call;
        host_.serveCall(call_);
        fds_ = std::move(received.value().fds);
        if (!timeline_ && !std::holds_alternative<Hello>(received.value().message)) {
            return breachOfHost("its first message is no hello");
        }
        UniqueFd with;
        const Message answer =
            std::visit([&](const auto& call) -> Message { return handle(call, with); }, received.value().message);
        fds_.clear();
        host_.flushTrace();
        if (const auto& breach = breach_ ? breach_ : host_.breach()) {
            return *breach;
        }
        const int fd = with.get();
        const std::span<const int> fds(&fd, with.valid() ? 1 : 0);
        if (Status sent = channel_.send(answer, call_, fds, kSendNs); !sent) {
            return sent.error().code == SLUICE_ERROR_DEVICE_LOST ? Status{} : sent;
        }
        if (carriers_ && accepted_) {
            carriers_->promise(*accepted_);
        }
        accepted_.reset();
    }
}

Message Server::handle(const Hello& hello, UniqueFd& /*with*/) {
    if (timeline_) {
        breach_ = breachOfHost("it said hello twice");
        return Answer{};
    }
    Result<std::unique_ptr<SharedTimeline>> timeline = SharedTimeline::adopt(std::move(fds_.at(0)));
    if (!timeline) {
        breach_ = timeline.error();
        return Answer{};
    }
    timeline_ = std::move(timeline).value();
    hello_ = hello;
    return Welcome{{}, api_.abi_version, api_.name, api_.version != nullptr ? api_.version : ""};
}

Message Server::handle(const Describe& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    auto found = sized<SluiceRendererCapabilities>();
    const SluiceHostServices services = host_.services(call.wants_trace);
    const SluiceResult result = api_.describe(&services, &call.info, &found, &error);
    return said(result, error, found);
}

Message Server::handle(const Explain& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    const auto sink = [](void* user, const char* line) {
        static_cast<HostEnd*>(user)->tell(Line{{}, line != nullptr ? line : ""});
    };
    const SluiceResult result = api_.explain(&call.needs, sink, &host_, &error);
    return said(result, error);
}

Message Server::handle(const Create& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (renderer_ != nullptr) {
        breach_ = breachOfHost("it asked for a second renderer");
        return Answer{};
    }
    services_ = host_.services(call.wants_trace);
    const SluiceResult result = api_.create(&services_, &call.info, &renderer_, &error);
    if (result != SLUICE_OK || renderer_ == nullptr) {
        renderer_ = nullptr;
        return said(result == SLUICE_OK ? SLUICE_ERROR_INTERNAL : result, error);
    }
    auto info = sized<SluiceRendererInfo>();
    (void)api_.info(renderer_, &info);
    // Where GL signals by itself, or nobody does, the host's values do not come this way.
    host_value_matters_ = info.timeline == SLUICE_TIMELINE_BRIDGED || info.timeline == SLUICE_TIMELINE_FINISH;
    carriers_.emplace(api_, renderer_, *timeline_, hello_);
    return said(result, error);
}

Message Server::handle(const Info& /*call*/, UniqueFd& /*with*/) {
    auto info = sized<SluiceRendererInfo>();
    const SluiceResult result = api_.info(renderer_, &info);
    return said(result, sized<SluiceError>(), info);
}

Message Server::handle(const Resize& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    const SluiceResult result = api_.resize(renderer_, call.width, call.height, &error);
    return said(result, error);
}

Message Server::handle(const Simulate& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    const SluiceResult result =
        simulates(error) ? api_.simulate(renderer_, call.value, call.seconds, &error) : SLUICE_ERROR_UNSUPPORTED;
    return said(result, error);
}

Message Server::handle(const SimulationStats& /*call*/, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    auto stats = sized<SluiceSimulationStats>();
    const SluiceResult result = simulates(error) ? api_.simulation_stats(renderer_, &stats) : SLUICE_ERROR_UNSUPPORTED;
    return said(result, error, stats);
}

Message Server::handle(const SimulationBodies& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    auto bodies = sized<SluiceBodies>();
    const SluiceResult result =
        moves(error) ? api_.simulation_bodies(renderer_, call.value, &bodies) : SLUICE_ERROR_UNSUPPORTED;
    return said(result, error, bodies);
}

Message Server::handle(const SetBody& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    const SluiceResult result =
        moves(error) ? api_.set_body(renderer_, call.body, &call.target, &error) : SLUICE_ERROR_UNSUPPORTED;
    return said(result, error);
}

Message Server::handle(const SetFlow& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (api_.set_flow == nullptr) {
        writeAbiError(&error, {SLUICE_ERROR_UNSUPPORTED, "the plugin", "does not know set_flow", "use a newer one"});
        return said(SLUICE_ERROR_UNSUPPORTED, error);
    }
    if (const Status served = checkServed(call.flow, api_); !served) {
        writeAbiError(&error, served.error());
        return said(served.error().code, error);
    }
    const SluiceResult result = api_.set_flow(renderer_, &call.flow, &error);
    return said(result, error);
}

Message Server::handle(const SubmitFrame& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (carriers_) {
        carriers_->forward();  // FINISH wants the host's value to be there
    }
    const SluiceResult result = api_.submit_frame(renderer_, &call.frame, &error);
    if (result == SLUICE_OK) {
        dieIfAsked(hello_, call.frame.frame, true);
        const bool waits = host_value_matters_ && (call.frame.flags & SLUICE_FRAME_SKIP_WAIT) == 0;
        accepted_ = Promise{waits ? call.frame.wait_value : 0, call.frame.signal_value};
    }
    return said(result, error);
}

Message Server::handle(const Poll& call, UniqueFd& /*with*/) {
    auto stats = sized<SluiceFrameStats>();
    const SluiceResult result = api_.poll(renderer_, call.frame, &stats);
    return said(result, sized<SluiceError>(), stats);
}

Message Server::handle(const TimelineValue& call, UniqueFd& /*with*/) {
    Returned answer;
    answer.result = api_.timeline_value(renderer_, call.direction, &answer.value);
    return answer;
}

Message Server::handle(const TimelineExport& call, UniqueFd& with) {
    auto error = sized<SluiceError>();
    std::int32_t fd = -1;
    const SluiceResult result = api_.timeline_export(renderer_, call.direction, call.value, &fd, &error);
    with.reset(result == SLUICE_OK ? fd : -1);
    return said(result, error);
}

Message Server::handle(const ProbeFormat& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    const SluiceHostServices services = host_.services(call.wants_trace);
    const SluiceResult result = api_.probe_format(&services, &call.info, call.format, call.width, call.height, &error);
    return said(result, error);
}

Message Server::handle(const Destroy& /*call*/, UniqueFd& /*with*/) {
    destroyRenderer();
    return Returned{};
}

bool Server::simulates(SluiceError& error) const {
    const bool all = api_.set_simulation != nullptr && api_.simulate != nullptr && api_.simulation_stats != nullptr;
    if (!all) {
        writeAbiError(&error, {SLUICE_ERROR_UNSUPPORTED, "the plugin", "serves ABI 1.0 and simulates nothing",
                               "use a newer one, or give it particles"});
    }
    return all;
}

bool Server::moves(SluiceError& error) const {
    const bool all = api_.simulation_bodies != nullptr && api_.set_body != nullptr;
    if (!all) {
        writeAbiError(
            &error, {SLUICE_ERROR_UNSUPPORTED, "the plugin", "serves ABI 1.1 and knows no bodies", "use a newer one"});
    }
    return all;
}

void Server::destroyRenderer() {
    carriers_.reset();
    if (renderer_ != nullptr) {
        api_.destroy(std::exchange(renderer_, nullptr));
    }
}

}  // namespace sluice::isolate
