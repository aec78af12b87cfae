// SPDX-License-Identifier: MIT
#include "frame/renderer.hpp"

#include <fmt/format.h>

#include <chrono>
#include <string_view>
#include <thread>

#include "share/renderer_error.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/simulation_arrays.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

namespace {

// Short against a frame, long against a poll.
constexpr std::chrono::microseconds kPollInterval{200};

Status statusOf(std::string_view call, SluiceResult result, const SluiceError& said) {
    if (result != SLUICE_OK) {
        return rendererError(call, result, said);
    }
    return {};
}

/// What the renderer has filled of `answer`, which went out with this host's size; the rest is zero.
template <typename T>
Result<T> filled(std::string_view call, const T& answer) {
    if (Status status = checkAbiStruct(&answer, call); !status) {
        return Error{SLUICE_ERROR_INTERNAL, fmt::format("renderer {}", call), status.error().detail,
                     "the plugin is broken"};
    }
    return readAbiStruct(answer);
}

/// Text that goes on to its array's end ends there.
template <std::size_t N>
void terminate(char (&text)[N]) {
    text[N - 1] = '\0';
}

Result<SluiceFrameStats> checkedStats(Result<SluiceFrameStats> stats) {
    if (!stats) {
        return stats;
    }
    if (stats.value().pass_count > SLUICE_MAX_PASSES) {
        return Error{SLUICE_ERROR_INTERNAL, "renderer poll",
                     fmt::format("expected {} passes at most, found {}", SLUICE_MAX_PASSES, stats.value().pass_count),
                     "the plugin is broken"};
    }
    for (SluicePassStats& pass : stats.value().passes) {
        terminate(pass.name);
    }
    return stats;
}

Status checkSimulates(const SluiceRendererApi& api) {
    if (api.set_simulation == nullptr || api.simulate == nullptr || api.simulation_wait == nullptr ||
        api.simulation_stats == nullptr) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("renderer {}", api.name),
                     fmt::format("serves ABI {}.{} and simulates nothing; that came with 1.1", api.abi_version >> 16U,
                                 api.abi_version & 0xffffU),
                     "use a newer plugin, or give it particles"};
    }
    return {};
}

Status checkMoves(const SluiceRendererApi& api) {
    if (api.simulation_bodies == nullptr || api.set_body == nullptr) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("renderer {}", api.name),
                     fmt::format("serves ABI {}.{} and knows no bodies; they came with 1.2", api.abi_version >> 16U,
                                 api.abi_version & 0xffffU),
                     "use a newer plugin"};
    }
    return {};
}

}  // namespace

Result<Renderer> Renderer::create(const SluiceRendererApi& api, const SluiceHostServices& services,
                                  const SluiceCreateInfo& info) {
    auto said = sized<SluiceError>();
    SluiceRenderer* handle = nullptr;
    const SluiceResult result = api.create(&services, &info, &handle, &said);
    if (result != SLUICE_OK) {
        return rendererError("create", result, said);
    }
    if (handle == nullptr) {
        return Error{SLUICE_ERROR_INTERNAL, "renderer create", "reported success but returned no renderer",
                     "the plugin is broken"};
    }
    Renderer renderer;
    renderer.api_ = &api;
    renderer.handle_ = handle;
    return renderer;
}

Renderer::~Renderer() {
    if (handle_ != nullptr) {
        api_->destroy(handle_);
    }
}

Result<SluiceRendererInfo> Renderer::info() const {
    auto info = sized<SluiceRendererInfo>();
    if (const SluiceResult result = api_->info(handle_, &info); result != SLUICE_OK) {
        return rendererError("info", result, sized<SluiceError>());
    }
    Result<SluiceRendererInfo> answer = filled("info", info);
    if (answer) {
        SluiceRendererCapabilities& said = answer.value().capabilities;
        terminate(said.device_name);
        terminate(said.driver_name);
        terminate(said.driver_info);
    }
    return answer;
}

Status Renderer::resize(std::uint32_t width, std::uint32_t height) const {
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->resize(handle_, width, height, &said);
    return statusOf("resize", result, said);
}

Status Renderer::setParticles(const SluiceParticles& particles) const {
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->set_particles(handle_, &particles, &said);
    return statusOf("set_particles", result, said);
}

Status Renderer::setEnvironment(const SluiceEnvironment* environment) const {
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->set_environment(handle_, environment, &said);
    return statusOf("set_environment", result, said);
}

Status Renderer::setSimulation(const SluiceSimulation* simulation) const {
    if (Status status = checkSimulates(*api_); !status) {
        return status;
    }
    if (simulation != nullptr) {
        if (Status status = checkServed(readAbiStruct(*simulation), *api_); !status) {
            (void)api_->set_simulation(handle_, nullptr, nullptr);  // on failure there is none
            return status;
        }
    }
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->set_simulation(handle_, simulation, &said);
    return statusOf("set_simulation", result, said);
}

Status Renderer::simulate(std::uint64_t value, double seconds) const {
    if (Status status = checkSimulates(*api_); !status) {
        return status;
    }
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->simulate(handle_, value, seconds, &said);
    return statusOf("simulate", result, said);
}

Status Renderer::waitForSimulation(std::uint64_t value, std::uint64_t timeout_ns) const {
    if (Status status = checkSimulates(*api_); !status) {
        return status;
    }
    const SluiceResult result = api_->simulation_wait(handle_, value, timeout_ns);
    if (result == SLUICE_TIMEOUT) {
        return Error{
            SLUICE_TIMEOUT, "simulation",
            fmt::format("value {} was not reached within {:.3f} s", value, static_cast<double>(timeout_ns) * 1e-9), ""};
    }
    return statusOf("simulation_wait", result, sized<SluiceError>());
}

Result<SluiceSimulationStats> Renderer::simulationStats() const {
    if (Status status = checkSimulates(*api_); !status) {
        return status.error();
    }
    auto stats = sized<SluiceSimulationStats>();
    if (const SluiceResult result = api_->simulation_stats(handle_, &stats); result != SLUICE_OK) {
        return rendererError("simulation_stats", result, sized<SluiceError>());
    }
    Result<SluiceSimulationStats> answer = filled("simulation_stats", stats);
    if (answer) {
        terminate(answer.value().message);
    }
    return answer;
}

Result<SluiceBodies> Renderer::simulationBodies(std::uint64_t value) const {
    if (Status status = checkMoves(*api_); !status) {
        return status.error();
    }
    auto bodies = sized<SluiceBodies>();
    const SluiceResult result = api_->simulation_bodies(handle_, value, &bodies);
    if (result == SLUICE_NOT_READY) {
        return Error{SLUICE_NOT_READY, "simulation_bodies", fmt::format("value {} has not been simulated yet", value),
                     "wait for it"};
    }
    if (result != SLUICE_OK) {
        return rendererError("simulation_bodies", result, sized<SluiceError>());
    }
    Result<SluiceBodies> answer = filled("simulation_bodies", bodies);
    if (answer && answer.value().count > SLUICE_MAX_BODIES) {
        return Error{SLUICE_ERROR_INTERNAL, "simulation_bodies",
                     fmt::format("expected {} bodies at most, found {}", SLUICE_MAX_BODIES, answer.value().count),
                     "the plugin is broken"};
    }
    return answer;
}

Status Renderer::setBody(std::uint32_t body, const SluiceBodyTarget& target) const {
    if (Status status = checkMoves(*api_); !status) {
        return status;
    }
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->set_body(handle_, body, &target, &said);
    return statusOf("set_body", result, said);
}

Status Renderer::setFlow(const SluiceFlow& flow) const {
    if (api_->set_flow == nullptr) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("renderer {}", api_->name), "does not know set_flow",
                     "use a newer plugin"};
    }
    if (Status status = checkServed(readAbiStruct(flow), *api_); !status) {
        return status;
    }
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->set_flow(handle_, &flow, &said);
    return statusOf("set_flow", result, said);
}

Status Renderer::resetSimulation(const SluiceStart& start) const {
    if (api_->reset_simulation == nullptr) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("renderer {}", api_->name), "does not know reset_simulation",
                     "use a newer plugin, or set_simulation"};
    }
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->reset_simulation(handle_, &start, &said);
    return statusOf("reset_simulation", result, said);
}

Status Renderer::submit(const SluiceFrame& frame) const {
    auto said = sized<SluiceError>();
    const SluiceResult result = api_->submit_frame(handle_, &frame, &said);
    return statusOf("submit_frame", result, said);
}

Result<SluiceFrameStats> Renderer::stats(std::uint64_t frame, std::uint64_t timeout_ns) const {
    const std::uint64_t begin = monotonicNanoseconds();
    for (;;) {
        auto stats = sized<SluiceFrameStats>();
        const SluiceResult result = api_->poll(handle_, frame, &stats);
        if (result == SLUICE_OK) {
            return checkedStats(filled("poll", stats));
        }
        if (result != SLUICE_NOT_READY) {
            return rendererError("poll", result, sized<SluiceError>());
        }
        if (monotonicNanoseconds() - begin >= timeout_ns) {
            return Error{
                SLUICE_TIMEOUT, "renderer poll",
                fmt::format("frame {} did not finish within {:.3f} s", frame, static_cast<double>(timeout_ns) * 1e-9),
                "raise wait_timeout_ns"};
        }
        std::this_thread::sleep_for(kPollInterval);
    }
}

}  // namespace sluice::host
