// SPDX-License-Identifier: MIT
// What holds from start-up on, and changes with a resize only: renderer, shared images, timeline.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "compositor/linear_depth.hpp"
#include "frame/host_services.hpp"
#include "frame/image_sets.hpp"
#include "frame/renderer.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::host {

/// One renderer and the host's end of all that the two share. The renderer knows the address of the services, so it
/// neither moves nor copies. GL thread.
struct Connection {
    explicit Connection(const FluidHostConfig& wanted)
        : config(wanted),
          services(wanted.log, wanted.trace, wanted.ledger != nullptr ? &shares.emplace(*wanted.ledger) : nullptr) {}
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;
    ~Connection() { close(); }

    /// With AUTO, a timeline that is advertised but fails at start-up makes way for the next kind.
    [[nodiscard]] Status open(const PluginLibrary& library);
    /// Replaces every shared image. GL must have finished with them. On failure there are none until a resize succeeds.
    [[nodiscard]] Status resize(std::uint32_t width, std::uint32_t height);
    /// `drained`: GL is through with the images, and the renderer waits for its device before it goes. Of images whose
    /// use may not have ended the ledger is not told the end.
    void close(bool drained = true);

    FluidHostConfig config;
    std::optional<ledger::ShareFeed> shares;  ///< empty without a ledger, as `feed`
    HostServices services;
    Renderer renderer;
    SluiceRendererInfo info{};
    SluiceHostCapabilities capabilities{};
    std::optional<LinearDepthPass> linear;  ///< where HOST_DEPTH is linear
    std::optional<ImageSets> sets;
    std::optional<ledger::HandOffFeed> feed;
    std::unique_ptr<HostTimeline> timeline;

  private:
    /// How far an attempt to open came.
    enum class Stage : std::uint8_t { Renderer, Timeline, Done };
    [[nodiscard]] Status attempt(const PluginLibrary& library, SluiceTimelineKind kind, Stage& stage);
    [[nodiscard]] Status adoptImages();
    /// Tells the ledger of the images that there are now.
    void tellImages();
    /// SLUICE_ROLE_BITs of what every set has.
    [[nodiscard]] std::uint32_t sharedRoles() const;
};

}  // namespace sluice::host
