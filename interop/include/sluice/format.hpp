// SPDX-License-Identifier: MIT
// What each shareable format is on either side, as plain numbers so that no API header is needed to read the table.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "sluice/plugin.h"

namespace sluice {

/// What texels of a format hold.
enum class TexelKind : std::uint8_t { UnsignedNormalized, Float, UnsignedInteger, Depth, DepthStencil };

/// One row of the format table. The numeric values are those of the Vulkan and OpenGL registries; tests/interop checks
/// them against the real headers.
struct FormatInfo {
    SluiceFormat format;
    std::string_view name;             ///< "R32F"
    std::uint32_t vk_format;           ///< VkFormat
    std::uint32_t gl_internal;         ///< sized internal format for glTexStorageMem2DEXT
    std::uint32_t gl_transfer_format;  ///< for glTexSubImage2D / glGetTexImage
    std::uint32_t gl_transfer_type;
    std::uint32_t bytes_per_texel;  ///< of the transfer layout, which equals the Vulkan buffer-copy layout
    std::uint32_t channels;
    TexelKind kind;
    bool
        exact_round_trip;  ///< every bit survives transfer both ways (false for D24S8: GL packs depth high, Vulkan low)
    std::string_view hazard;        ///< channel-order or packing trap, empty if none
    std::string_view host_use;      ///< what the GL side may do with it
    std::string_view renderer_use;  ///< what the Vulkan side may do with it
};

/// Every format, in the order of SluiceFormat, without NONE.
[[nodiscard]] std::span<const FormatInfo> formatTable();
/// The row of `format`, or nullptr for NONE and unknown values.
[[nodiscard]] const FormatInfo* findFormat(std::uint32_t format);
/// The row whose name is `name` (case-sensitive), or nullptr.
[[nodiscard]] const FormatInfo* findFormat(std::string_view name);
[[nodiscard]] constexpr std::uint32_t formatBit(std::uint32_t format) {
    return 1u << format;
}
[[nodiscard]] std::string_view toString(SluiceImageRole role);
[[nodiscard]] std::string_view toString(SluiceTimelineKind kind);
/// "native", "binary", "bridged", "finish", "unsynchronised", "auto" -> kind.
[[nodiscard]] std::optional<SluiceTimelineKind> parseTimelineKind(std::string_view name);

}  // namespace sluice
