// SPDX-License-Identifier: MIT
// Which frame uses which image set, and whether the host may: the protocol as the host lives it.
#pragma once

#include <cstdint>
#include <vector>

#include "share/image_table.hpp"
#include "sluice/result.hpp"
#include "sluice/timeline.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

/// One ring of image sets. Every step goes through sluice::HandOff, so that a step out of order is an error and not a
/// race; the trace gets one ACQUIRE or RELEASE per image. GL thread.
class ImageSets {
  public:
    ImageSets(std::uint32_t sets, const ImageTable& images, Trace* trace);

    /// The renderer value to wait for before frame k may be captured, 0 for none: only values that somebody promised.
    [[nodiscard]] std::uint64_t owedBefore(std::uint64_t frame) const;
    /// The renderer's counter is known to have reached `value`.
    void reached(std::uint64_t value);

    [[nodiscard]] Status beginCapture(std::uint64_t frame);
    /// Undoes beginCapture: frame k has not been given away and its number may be used again.
    void cancelCapture(std::uint64_t frame);
    /// gbufferWritten(frame) has been signalled.
    [[nodiscard]] Status endCapture(std::uint64_t frame);
    /// submit_frame has succeeded: the renderer has promised fluidWritten(frame).
    [[nodiscard]] Status promised(std::uint64_t frame);
    /// submit_frame has failed: the set is the host's again.
    void abandoned(std::uint64_t frame);
    [[nodiscard]] Status beginComposite(std::uint64_t frame);
    [[nodiscard]] Status endComposite(std::uint64_t frame);
    /// All images are new and the host's.
    void reset();

  private:
    struct Set {
        HandOff hand_off;
        HandOff before_capture;
        std::uint64_t owed = 0;  ///< promised by the renderer and not yet known to be reached
        bool held = false;       ///< the last event of its images was ACQUIRE
    };
    [[nodiscard]] Set& of(std::uint64_t frame);
    void traceImages(std::uint64_t frame, SluiceTraceKind kind) const;
    void take(Set& set, std::uint64_t frame) const;
    void give(Set& set, std::uint64_t frame) const;

    std::vector<Set> sets_;
    const ImageTable* images_;
    Trace* trace_;
    std::uint64_t reached_ = 0;
};

}  // namespace sluice::host
