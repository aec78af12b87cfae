// SPDX-License-Identifier: MIT
// What a machine's GL and Vulkan can share, as tables and as JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sluice/negotiate.hpp"
#include "sluice/plugin.h"

namespace sluice::cli {

/// One canary round trip, both directions.
struct CanaryTrial {
    std::uint32_t width = 0, height = 0;
    bool passed = false;
    std::string why;  ///< of a failure
};

struct FormatProbe {
    SluiceFormat format = SLUICE_FORMAT_NONE;
    bool gl_texture = false, gl_attachment = false, vk_exportable = false, vk_storage = false, vk_blendable = false;
    std::vector<CanaryTrial> canaries;  ///< empty if a side cannot even make the image
    [[nodiscard]] bool shared() const;  ///< every canary passed, and there was one
};

struct TimelineProbe {
    SluiceTimelineKind kind = SLUICE_TIMELINE_AUTO;
    bool possible = false, chosen = false;
    std::string why;
};

struct ProbeResult {
    SluiceHostCapabilities gl{};
    std::optional<SluiceRendererCapabilities> vk;  ///< empty: no renderer or no matching device
    std::string renderer, plugin;
    bool same_device = false;
    std::vector<FormatProbe> formats;
    std::vector<TimelineProbe> timelines;
    std::optional<Agreement> agreement;
    std::vector<std::string> problems;
    std::string gl_device_note;  ///< why OpenGL is not on the graphics card, if so
    std::vector<std::string> egl_devices;
    [[nodiscard]] bool possible() const { return agreement.has_value(); }
};

[[nodiscard]] std::string probeText(const ProbeResult& probe);
[[nodiscard]] nlohmann::ordered_json probeJson(const ProbeResult& probe);

}  // namespace sluice::cli
