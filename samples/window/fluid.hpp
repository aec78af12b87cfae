// SPDX-License-Identifier: MIT
// The water: what the panel sets of it, and the calls of sluice/sluice.h.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>

#include "options.hpp"
#include "orbit.hpp"
#include "sluice/sluice.h"

namespace window {

/// What the panel shows and changes.
struct FluidSettings {
    SluiceFluid look{};
    SluiceFlow flow{};       ///< its emitters are the Fluid's
    float radius = 0.05F;    ///< from the next start on
    float jet_width = 0.4F;  ///< metres
    float jet_speed = 3.0F;  ///< m/s
};

/// Belongs to the context that is current when it is made.
class Fluid {
  public:
    /// On failure the error is in `why`, and the pointer empty.
    [[nodiscard]] static std::unique_ptr<Fluid> create(const Options& options, glm::ivec2 size, std::string& why);
    Fluid(const Fluid&) = delete;
    Fluid& operator=(const Fluid&) = delete;
    ~Fluid();

    FluidSettings settings;

    /// The fluid as it was at the start, with the radius of the settings.
    void restart();
    void resize(glm::ivec2 size);
    /// A jet that falls on that point, from the next frame on; none: it is shut.
    void pour(const std::optional<glm::vec3>& onto);
    /// The scene is drawn between the two. `time` in seconds; the fluid flows as far as it has grown.
    void begin(const Orbit& orbit, glm::ivec2 size, double time);
    void end();

    [[nodiscard]] SluiceStatistics statistics() const;
    /// Empty while all goes well.
    [[nodiscard]] const std::string& trouble() const { return trouble_; }
    [[nodiscard]] const SluiceSky& sky() const { return sky_; }

  private:
    explicit Fluid(Sluice* sluice, const Options& options);
    void heed(SluiceResult result);
    [[nodiscard]] SluiceEmitter jet(glm::vec3 onto) const;

    Sluice* sluice_;
    Preset preset_;
    SluiceSky sky_{};
    std::optional<glm::vec3> poured_;
    std::optional<SluiceFlow> sent_;  ///< what flows
    std::string trouble_;
};

}  // namespace window
