// SPDX-License-Identifier: MIT
// The framebuffer that the engine has bound for drawing, and one without samples to take its contents from.
#pragma once

#include <cstdint>
#include <optional>

#include "api/current_context.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// What is bound for drawing.
struct Target {
    std::uint32_t framebuffer = 0;                      ///< 0: the window's
    std::uint32_t samples = 0;                          ///< 0: one
    std::optional<Extent> extent;                       ///< of a framebuffer object's colour; empty for the window
    std::uint32_t colour_format = 0, depth_format = 0;  ///< internal formats; of a framebuffer object only
    bool stencil = false;                               ///< the depth's format has stencil, too
};

/// Fails if nothing can be taken from it or drawn to it: it is incomplete, or has no depth, or layers.
[[nodiscard]] Result<Target> boundTarget();

/// A framebuffer object without samples, of the formats of one that has some: only equal formats can be resolved. Lives
/// in one context; freed with that current.
class Resolve {
  public:
    Resolve() = default;
    Resolve(const Resolve&) = delete;
    Resolve& operator=(const Resolve&) = delete;
    ~Resolve() { clear(); }

    /// Resolves the lower left of `target`; its name is then framebuffer(). Leaves all GL state as found.
    [[nodiscard]] Status take(const Target& target, const Extent& extent);
    [[nodiscard]] std::uint32_t framebuffer() const { return framebuffer_; }
    void clear();

  private:
    [[nodiscard]] Status make(const Target& target, const Extent& extent);

    std::uint32_t framebuffer_ = 0, colour_ = 0, depth_ = 0;
    std::uint32_t colour_format_ = 0, depth_format_ = 0;
    Extent extent_{};
};

}  // namespace sluice::host
