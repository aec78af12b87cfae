// SPDX-License-Identifier: MIT
#include "sluice/isolate/server.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "isolate/carriers.hpp"
#include "isolate/host_end.hpp"
#include "isolate/simulation_memory.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/blocked_signals.hpp"
#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/isolate/shared_timeline.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::isolate {

namespace {

template <typename T>
Returned said(SluiceResult result, const SluiceError& error, const T& filled) {
    Returned answer;
    answer.result = result;
    answer.message.assign(&error.message[0], strnlen(&error.message[0], sizeof(error.message)));
    answer.filled = filled;
    return answer;
}
Returned said(SluiceResult result, const SluiceError& error) {
    return said(result, error, std::monostate{});
}

class Server {
  public:
    Server(const SluiceRendererApi& api, const Channel& channel) : api_(api), channel_(channel), host_(channel) {}
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    ~Server() { destroyRenderer(); }

    [[nodiscard]] Status run();

  private:
    // ---- calls of the host
    Message handle(const Hello& hello, UniqueFd& /*with*/) {
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
    Message handle(const Describe& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        auto found = sized<SluiceRendererCapabilities>();
        const SluiceHostServices services = host_.services(call.wants_trace);
        const SluiceResult result = api_.describe(&services, &call.info, &found, &error);
        return said(result, error, found);
    }
    Message handle(const Explain& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        const auto sink = [](void* user, const char* line) {
            static_cast<HostEnd*>(user)->tell(Line{{}, line != nullptr ? line : ""});
        };
        const SluiceResult result = api_.explain(&call.needs, sink, &host_, &error);
        return said(result, error);
    }
    Message handle(const Create& call, UniqueFd& /*with*/) {
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
    Message handle(const Info& /*call*/, UniqueFd& /*with*/) {
        auto info = sized<SluiceRendererInfo>();
        const SluiceResult result = api_.info(renderer_, &info);
        return said(result, sized<SluiceError>(), info);
    }
    Message handle(const Resize& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        const SluiceResult result = api_.resize(renderer_, call.width, call.height, &error);
        return said(result, error);
    }
    Message handle(const SetParticles& call, UniqueFd& /*with*/);
    Message handle(const SetEnvironment& call, UniqueFd& /*with*/);
    Message handle(const SetSimulation& call, UniqueFd& /*with*/);
    Message handle(const Simulate& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        const SluiceResult result =
            simulates(error) ? api_.simulate(renderer_, call.value, call.seconds, &error) : SLUICE_ERROR_UNSUPPORTED;
        return said(result, error);
    }
    Message handle(const SimulationStats& /*call*/, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        auto stats = sized<SluiceSimulationStats>();
        const SluiceResult result =
            simulates(error) ? api_.simulation_stats(renderer_, &stats) : SLUICE_ERROR_UNSUPPORTED;
        return said(result, error, stats);
    }
    Message handle(const SimulationBodies& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        auto bodies = sized<SluiceBodies>();
        const SluiceResult result =
            moves(error) ? api_.simulation_bodies(renderer_, call.value, &bodies) : SLUICE_ERROR_UNSUPPORTED;
        return said(result, error, bodies);
    }
    Message handle(const SetBody& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        const SluiceResult result =
            moves(error) ? api_.set_body(renderer_, call.body, &call.target, &error) : SLUICE_ERROR_UNSUPPORTED;
        return said(result, error);
    }
    Message handle(const SetFlow& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        if (api_.set_flow == nullptr) {
            writeAbiError(&error,
                          {SLUICE_ERROR_UNSUPPORTED, "the plugin", "does not know set_flow", "use a newer one"});
            return said(SLUICE_ERROR_UNSUPPORTED, error);
        }
        if (const Status served = checkServed(call.flow, api_); !served) {
            writeAbiError(&error, served.error());
            return said(served.error().code, error);
        }
        const SluiceResult result = api_.set_flow(renderer_, &call.flow, &error);
        return said(result, error);
    }
    Message handle(const ResetSimulation& call, UniqueFd& /*with*/);
    Message handle(const SubmitFrame& call, UniqueFd& /*with*/) {
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
    Message handle(const Poll& call, UniqueFd& /*with*/) {
        auto stats = sized<SluiceFrameStats>();
        const SluiceResult result = api_.poll(renderer_, call.frame, &stats);
        return said(result, sized<SluiceError>(), stats);
    }
    Message handle(const TimelineValue& call, UniqueFd& /*with*/) {
        Returned answer;
        answer.result = api_.timeline_value(renderer_, call.direction, &answer.value);
        return answer;
    }
    Message handle(const TimelineExport& call, UniqueFd& with) {
        auto error = sized<SluiceError>();
        std::int32_t fd = -1;
        const SluiceResult result = api_.timeline_export(renderer_, call.direction, call.value, &fd, &error);
        with.reset(result == SLUICE_OK ? fd : -1);
        return said(result, error);
    }
    Message handle(const ProbeFormat& call, UniqueFd& /*with*/) {
        auto error = sized<SluiceError>();
        const SluiceHostServices services = host_.services(call.wants_trace);
        const SluiceResult result =
            api_.probe_format(&services, &call.info, call.format, call.width, call.height, &error);
        return said(result, error);
    }
    Message handle(const Destroy& /*call*/, UniqueFd& /*with*/) {
        destroyRenderer();
        return Returned{};
    }
    /// What only this side says.
    template <typename T>
    Message handle(const T& /*call*/, UniqueFd& /*with*/) {
        breach_ = breachOfHost("it sent a " + std::string(T::kName) + " where a call was expected");
        return Answer{};
    }

    /// Whether the plugin's table goes that far (ABI 1.1).
    [[nodiscard]] bool simulates(SluiceError& error) const {
        const bool all = api_.set_simulation != nullptr && api_.simulate != nullptr && api_.simulation_stats != nullptr;
        if (!all) {
            writeAbiError(&error, {SLUICE_ERROR_UNSUPPORTED, "the plugin", "serves ABI 1.0 and simulates nothing",
                                   "use a newer one, or give it particles"});
        }
        return all;
    }
    /// Likewise ABI 1.2.
    [[nodiscard]] bool moves(SluiceError& error) const {
        const bool all = api_.simulation_bodies != nullptr && api_.set_body != nullptr;
        if (!all) {
            writeAbiError(&error, {SLUICE_ERROR_UNSUPPORTED, "the plugin", "serves ABI 1.1 and knows no bodies",
                                   "use a newer one"});
        }
        return all;
    }
    void destroyRenderer() {
        carriers_.reset();
        if (renderer_ != nullptr) {
            api_.destroy(std::exchange(renderer_, nullptr));
        }
    }

    const SluiceRendererApi& api_;
    const Channel& channel_;
    HostEnd host_;
    Hello hello_;
    std::unique_ptr<SharedTimeline> timeline_;
    SluiceHostServices services_{};
    SluiceRenderer* renderer_ = nullptr;
    std::optional<Carriers> carriers_;
    bool host_value_matters_ = true;
    std::optional<Promise> accepted_;  ///< a frame whose value is told after submit_frame has returned
    std::uint64_t call_ = 0;
    std::vector<UniqueFd> fds_;  ///< that came with it
    std::optional<Error> breach_;
};

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

Message Server::handle(const SetParticles& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    auto particles = sized<SluiceParticles>();
    particles.count = call.count;
    particles.radius = call.radius;
    Mapping memory;
    if (!fds_.empty()) {
        const std::size_t floats = std::size_t{3} * call.count;
        const std::size_t arrays = 1U + (call.has_velocity != 0 ? 1U : 0U) + (call.has_colour != 0 ? 1U : 0U);
        const std::size_t numbers = call.has_fluid != 0 ? call.count : 0;
        Result<Mapping> mapped =
            mapSealed(fds_.front(), arrays * floats * sizeof(float) + numbers * sizeof(std::uint32_t));
        if (!mapped) {
            writeAbiError(&error, mapped.error());
            return said(mapped.error().code, error);
        }
        memory = std::move(mapped).value();
        const auto* next = static_cast<const float*>(memory.at());
        particles.position = next;
        if (call.has_velocity != 0) {
            particles.velocity = next += floats;
        }
        if (call.has_colour != 0) {
            particles.colour = next += floats;
        }
        if (call.has_fluid != 0) {
            particles.fluid = static_cast<const std::uint32_t*>(static_cast<const void*>(next + floats));
        }
    }
    const SluiceResult result = api_.set_particles(renderer_, &particles, &error);
    return said(result, error);
}

Message Server::handle(const SetSimulation& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (!simulates(error)) {
        return said(SLUICE_ERROR_UNSUPPORTED, error);
    }
    if (fds_.empty()) {
        const SluiceResult result = api_.set_simulation(renderer_, nullptr, &error);
        return said(result, error);
    }
    SluiceSimulation simulation = call.simulation;
    const auto refuse = [&](const Error& why) {
        (void)api_.set_simulation(renderer_, nullptr, nullptr);  // on failure there is none
        writeAbiError(&error, why);
        return said(why.code, error);
    };
    if (const Status served = checkServed(simulation, api_); !served) {
        return refuse(served.error());
    }
    const Result<Mapping> mapped = placeArrays(simulation, call.has_velocity != 0, fds_.front());
    if (!mapped) {
        return refuse(mapped.error());
    }
    const SluiceResult result = api_.set_simulation(renderer_, &simulation, &error);
    return said(result, error);
}

Message Server::handle(const ResetSimulation& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (api_.reset_simulation == nullptr) {
        writeAbiError(&error,
                      {SLUICE_ERROR_UNSUPPORTED, "the plugin", "does not know reset_simulation", "use a newer one"});
        return said(SLUICE_ERROR_UNSUPPORTED, error);
    }
    SluiceStart start = call.start;
    start.position = start.velocity = nullptr;
    start.particle_fluids = nullptr;
    const std::size_t floats = std::size_t{3} * start.particle_count;
    Mapping memory;
    if (!fds_.empty()) {
        const std::size_t triples = call.has_velocity != 0 ? 2 : 1;
        const std::size_t numbers = call.has_fluids != 0 ? start.particle_count : 0;
        Result<Mapping> mapped =
            mapSealed(fds_.front(), triples * floats * sizeof(float) + numbers * sizeof(std::uint32_t));
        if (!mapped) {
            writeAbiError(&error, mapped.error());
            return said(mapped.error().code, error);
        }
        memory = std::move(mapped).value();
        start.position = static_cast<const float*>(memory.at());
        start.velocity = call.has_velocity != 0 ? start.position + floats : nullptr;
        if (call.has_fluids != 0) {
            const void* behind = start.position + triples * floats;
            start.particle_fluids = static_cast<const std::uint32_t*>(behind);
        }
    }
    const SluiceResult result = api_.reset_simulation(renderer_, &start, &error);
    return said(result, error);
}

Message Server::handle(const SetEnvironment& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (fds_.empty()) {
        const SluiceResult result = api_.set_environment(renderer_, nullptr, &error);
        return said(result, error);
    }
    const std::size_t floats = std::size_t{3} * call.width * call.height;
    if (call.width > SLUICE_MAX_EXTENT || call.height > SLUICE_MAX_EXTENT) {
        writeAbiError(&error, breachOfHost("it sent an environment map that is too large"));
        return said(SLUICE_ERROR_INVALID_ARGUMENT, error);
    }
    const Result<Mapping> mapped = mapSealed(fds_.front(), floats * sizeof(float));
    if (!mapped) {
        writeAbiError(&error, mapped.error());
        return said(mapped.error().code, error);
    }
    auto environment = sized<SluiceEnvironment>();
    environment.width = call.width;
    environment.height = call.height;
    environment.pixels = static_cast<const float*>(mapped.value().at());
    const SluiceResult result = api_.set_environment(renderer_, &environment, &error);
    return said(result, error);
}

}  // namespace

bool endWithHost(std::string_view host) {
    int pid = 0;
    std::from_chars(host.data(), host.data() + host.size(), pid);
    (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
    return ::getppid() == pid;
}

bool endWithWatchedHost() {
    pollfd host{kHostFd, POLLIN, 0};
    if (::fcntl(kHostFd, F_SETFD, FD_CLOEXEC) != 0 || ::poll(&host, 1, 0) != 0) {
        return false;
    }
    const BlockedSignals quiet;
    std::thread([host]() mutable {
        while (::poll(&host, 1, -1) < 0 && errno == EINTR) {
        }
        (void)::kill(::getpid(), SIGKILL);
    }).detach();
    return true;
}

Status serve(const SluiceRendererApi& api, const Channel& channel) {
    return Server(api, channel).run();
}

}  // namespace sluice::isolate
