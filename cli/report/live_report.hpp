// SPDX-License-Identifier: MIT
// What became of a simulation inside the renderer, for the summary of a render.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "sluice/plugin.h"

namespace sluice::cli {

struct LiveSummary {
    SluiceSimulationStats stats{};
    std::uint32_t frames_in_flight = 1;
};

[[nodiscard]] std::string liveText(const LiveSummary& live);
[[nodiscard]] nlohmann::ordered_json liveJson(const LiveSummary& live);

}  // namespace sluice::cli
