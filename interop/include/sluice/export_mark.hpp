// SPDX-License-Identifier: MIT
// The renderer's own word of an image that it exports, as a trace event beside share_image and canary: what the host
// was told comes by one way, what the renderer has done by the other, and the ledger holds the two against each other.
//
// The event: kind SLUICE_TRACE_MARK, track SLUICE_TRACK_RENDERER_CPU, name "export ROLE[set]", bytes the size of the
// allocation, value (dedicated << 32) | the number of the descriptor, 0xFFFFFFFF where it means nothing to the host. A
// renderer that sends none is taken by what it says in SluiceImageExport.
#pragma once

#include <cstdint>
#include <optional>

#include "sluice/plugin.h"

namespace sluice {

struct ExportMark {
    std::uint32_t role = 0, image_set = 0;
    std::uint64_t size = 0;
    std::uint32_t dedicated = 0;
    std::int32_t fd = -1;  ///< -1: that of another process
};

/// Sends the mark of `image`, if the host wants events. Comes directly before the call that hands the image over.
void markExport(const SluiceHostServices& host, const SluiceImageExport& image);

/// Empty for every other event.
[[nodiscard]] std::optional<ExportMark> exportMark(const SluiceTraceEvent& event);

/// The event's value as another process may read it: in a mark the number of the descriptor is left out.
[[nodiscard]] std::uint64_t valueElsewhere(const SluiceTraceEvent& event);

}  // namespace sluice
