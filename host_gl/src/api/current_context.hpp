// SPDX-License-Identifier: MIT
// The GL context that is current on this thread, whoever made it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "sluice/result.hpp"

namespace sluice::host {

enum class ContextKind : std::uint8_t { None, Egl, Glx };

struct CurrentContext {
    ContextKind kind = ContextKind::None;
    const void* handle = nullptr;

    friend bool operator==(const CurrentContext&, const CurrentContext&) = default;
};
[[nodiscard]] CurrentContext currentContext();

/// What `call` says where none is.
[[nodiscard]] Error noContext(const char* call);
/// Whether fluid can be composited in the one that is.
[[nodiscard]] Status checkContext();

using Extent = std::array<std::uint32_t, 2>;

/// Pixels of the window, pixmap or pbuffer that the current context draws to. Empty where it has none, or does not say.
[[nodiscard]] std::optional<Extent> drawableExtent(const CurrentContext& context);

}  // namespace sluice::host
