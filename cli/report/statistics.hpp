// SPDX-License-Identifier: MIT
// What a run cost, gathered frame by frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/trace.hpp"

namespace sluice::cli {

/// The middle value, or the mean of the two middle ones; 0 of nothing.
[[nodiscard]] double median(std::vector<double> values);

/// 0 of nothing.
[[nodiscard]] double maximum(const std::vector<double>& values);

/// One pass over all frames. A pass that ran several times in a frame counts with the sum of that frame.
struct PassRow {
    std::string name;
    std::uint64_t calls = 0;                             ///< over all frames
    std::uint64_t frames = 0;                            ///< frames in which it ran
    double median_ms = 0.0, min_ms = 0.0, max_ms = 0.0;  ///< per frame
    std::uint64_t elements = 0, bytes = 0;               ///< of the frame with the most
    std::uint64_t dispatches = 0;                        ///< median per frame
    bool particles = false;                              ///< elements are particles, else pixels
};

/// Gathers SluiceFrameStats; rows come in the order in which the passes were first seen.
class PassStatistics {
  public:
    void add(const SluiceFrameStats& stats);
    [[nodiscard]] std::vector<PassRow> rows() const;

  private:
    struct Samples {
        std::string name;
        std::uint64_t calls = 0;
        bool particles = false;
        std::vector<double> ms, elements, bytes, dispatches;
    };
    std::vector<Samples> passes_;
};

/// One thing the host's CPU did in each frame.
struct HostRow {
    std::string name;
    std::vector<double> ms;  ///< per frame
};

/// Bytes that the CPU moved, told apart by what they were for.
struct CopyBytes {
    std::uint64_t shared_images = 0;  ///< in the frame loop; 0 by contract
    std::uint64_t readback = 0;       ///< for output files
    std::uint64_t upload = 0;         ///< particles and environment
};

/// Sums CPU_COPY events. Names that begin with "read" are sluice::host's readbacks for output files, those that contain
/// "upload" are particles and environment maps; all others are counted against the contract.
void addCopies(CopyBytes& sum, const std::vector<TraceRecord>& records);

/// Milliseconds spent in blocking WAITs on the host's tracks.
[[nodiscard]] double waitMilliseconds(const std::vector<TraceRecord>& records);

}  // namespace sluice::cli
