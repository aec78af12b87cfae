// SPDX-License-Identifier: MIT
// One renderer behind the C ABI: codes and error structs become Results, and nothing it returns is trusted.
#pragma once

#include <cstdint>
#include <utility>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// Owns a SluiceRenderer. Move-only; the library and the services must outlive it. GL thread.
class Renderer {
  public:
    Renderer() = default;
    [[nodiscard]] static Result<Renderer> create(const SluiceRendererApi& api, const SluiceHostServices& services,
                                                 const SluiceCreateInfo& info);
    Renderer(Renderer&& other) noexcept
        : api_(std::exchange(other.api_, nullptr)), handle_(std::exchange(other.handle_, nullptr)) {}
    Renderer& operator=(Renderer&& other) noexcept {
        std::swap(api_, other.api_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    [[nodiscard]] const SluiceRendererApi& api() const { return *api_; }
    [[nodiscard]] SluiceRenderer* handle() const { return handle_; }

    [[nodiscard]] Result<SluiceRendererInfo> info() const;
    [[nodiscard]] Status resize(std::uint32_t width, std::uint32_t height) const;
    [[nodiscard]] Status setParticles(const SluiceParticles& particles) const;
    [[nodiscard]] Status setEnvironment(const SluiceEnvironment* environment) const;
    /// Those of a simulation: UNSUPPORTED where the plugin's table ends before them.
    [[nodiscard]] Status setSimulation(const SluiceSimulation* simulation) const;
    [[nodiscard]] Status simulate(std::uint64_t value, double seconds) const;
    [[nodiscard]] Status waitForSimulation(std::uint64_t value, std::uint64_t timeout_ns) const;
    [[nodiscard]] Result<SluiceSimulationStats> simulationStats() const;
    [[nodiscard]] Result<SluiceBodies> simulationBodies(std::uint64_t value) const;
    [[nodiscard]] Status setBody(std::uint32_t body, const SluiceBodyTarget& target) const;
    [[nodiscard]] Status setFlow(const SluiceFlow& flow) const;
    [[nodiscard]] Status resetSimulation(const SluiceStart& start) const;
    [[nodiscard]] Status submit(const SluiceFrame& frame) const;
    /// Polls until the frame has finished, for `timeout_ns` at most.
    [[nodiscard]] Result<SluiceFrameStats> stats(std::uint64_t frame, std::uint64_t timeout_ns) const;

  private:
    const SluiceRendererApi* api_ = nullptr;
    SluiceRenderer* handle_ = nullptr;
};

}  // namespace sluice::host
