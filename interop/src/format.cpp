// SPDX-License-Identifier: MIT
#include "sluice/format.hpp"

#include <algorithm>
#include <array>

namespace sluice {

namespace {

// Names of the registry values used below, so that a row can be read without a registry at hand.
namespace gl {
constexpr std::uint32_t kRed = 0x1903;
constexpr std::uint32_t kRg = 0x8227;
constexpr std::uint32_t kRgba = 0x1908;
constexpr std::uint32_t kRedInteger = 0x8D94;
constexpr std::uint32_t kDepth = 0x1902;
constexpr std::uint32_t kDepthStencil = 0x84F9;
constexpr std::uint32_t kByte = 0x1401;
constexpr std::uint32_t kUint = 0x1405;
constexpr std::uint32_t kFloat = 0x1406;
constexpr std::uint32_t kHalf = 0x140B;
constexpr std::uint32_t k2101010Rev = 0x8368;
constexpr std::uint32_t k248 = 0x84FA;
}  // namespace gl

constexpr std::string_view kColourHost = "sample, attach, capture with glCopyTexSubImage2D";
constexpr std::string_view kColourRenderer = "sample, attach, storage image, copy";

// exact_round_trip: bits survive glTexSubImage2D and glGetTexImage on one side and buffer copies on the other.
// Hazards are from facts measured on Mesa (channel swaps pass silently there) and from the packing rules of both
// specifications: OpenGL 4.6 section 8.4.4.2 (packed types), Vulkan 1.3 "Formats", table of depth/stencil copies.
constexpr std::array<FormatInfo, SLUICE_FORMAT_COUNT - 1> kTable{{
    {SLUICE_FORMAT_R8, "R8", 9, 0x8229, gl::kRed, gl::kByte, 1, 1, TexelKind::UnsignedNormalized, true,
     "rows are not 4-byte aligned: GL_UNPACK_ALIGNMENT and GL_PACK_ALIGNMENT must be 1", kColourHost, kColourRenderer},
    {SLUICE_FORMAT_RGBA8, "RGBA8", 37, 0x8058, gl::kRgba, gl::kByte, 4, 4, TexelKind::UnsignedNormalized, true,
     "VK_FORMAT_B8G8R8A8_UNORM under it swaps red and blue silently", kColourHost, kColourRenderer},
    {SLUICE_FORMAT_SRGB8_A8, "SRGB8_A8", 43, 0x8C43, gl::kRgba, gl::kByte, 4, 4, TexelKind::UnsignedNormalized, true,
     "sampling decodes on both sides, but a GL write encodes only under GL_FRAMEBUFFER_SRGB; "
     "VK_FORMAT_B8G8R8A8_SRGB swaps red and blue",
     kColourHost, "sample, attach, copy; a storage image only on few devices"},
    {SLUICE_FORMAT_RGB10_A2, "RGB10_A2", 64, 0x8059, gl::kRgba, gl::k2101010Rev, 4, 4, TexelKind::UnsignedNormalized,
     true, "it is A2B10G10R10; VK_FORMAT_A2R10G10B10_UNORM_PACK32 under it swaps red and blue silently", kColourHost,
     kColourRenderer},
    {SLUICE_FORMAT_R16F, "R16F", 76, 0x822D, gl::kRed, gl::kHalf, 2, 1, TexelKind::Float, true,
     "rows of odd width are not 4-byte aligned: GL_UNPACK_ALIGNMENT and GL_PACK_ALIGNMENT must be at most 2",
     kColourHost, "sample, attach, copy; storage image with shaderStorageImageExtendedFormats"},
    {SLUICE_FORMAT_RG16F, "RG16F", 83, 0x822F, gl::kRg, gl::kHalf, 4, 2, TexelKind::Float, true, "", kColourHost,
     "sample, attach, copy; storage image with shaderStorageImageExtendedFormats"},
    {SLUICE_FORMAT_RGBA16F, "RGBA16F", 97, 0x881A, gl::kRgba, gl::kHalf, 8, 4, TexelKind::Float, true, "", kColourHost,
     kColourRenderer},
    {SLUICE_FORMAT_R32F, "R32F", 100, 0x822E, gl::kRed, gl::kFloat, 4, 1, TexelKind::Float, true, "",
     "sample, attach; depth reaches it only through a fullscreen pass", kColourRenderer},
    {SLUICE_FORMAT_RG32F, "RG32F", 103, 0x8230, gl::kRg, gl::kFloat, 8, 2, TexelKind::Float, true, "", "sample, attach",
     "sample, attach, copy; storage image with shaderStorageImageExtendedFormats"},
    {SLUICE_FORMAT_RGBA32F, "RGBA32F", 109, 0x8814, gl::kRgba, gl::kFloat, 16, 4, TexelKind::Float, true, "",
     "sample, attach", "sample, attach, storage image, copy; blending is optional"},
    {SLUICE_FORMAT_R32UI, "R32UI", 98, 0x8236, gl::kRedInteger, gl::kUint, 4, 1, TexelKind::UnsignedInteger, true,
     "an integer format: nearest filtering only, and a float transfer format is an error",
     "sample with usampler, attach", "sample, attach, storage image with atomics, copy"},
    {SLUICE_FORMAT_D32F, "D32F", 126, 0x8CAC, gl::kDepth, gl::kFloat, 4, 1, TexelKind::Depth, true,
     "optimal tiling only; glBlitFramebuffer from another depth format is an error",
     "sample, depth attachment, capture with glCopyTexSubImage2D (converts)",
     "sample, depth attachment, copy of the depth aspect; never a storage image"},
    {SLUICE_FORMAT_D24S8, "D24S8", 129, 0x88F0, gl::kDepthStencil, gl::k248, 4, 2, TexelKind::DepthStencil, false,
     "GL transfers depth in the high 24 bits and stencil in the low 8; a Vulkan copy of the depth aspect has depth in "
     "the "
     "low 24 bits and copies stencil apart. Optimal tiling only, and absent on some devices",
     "sample, depth and stencil attachment, capture with glCopyTexSubImage2D",
     "sample one aspect, depth and stencil attachment, copy aspect by aspect; never a storage image"},
}};

struct NamedKind {
    std::string_view name;
    SluiceTimelineKind kind;
};
constexpr std::array<NamedKind, SLUICE_TIMELINE_KIND_COUNT> kTimelineKinds{{
    {"auto", SLUICE_TIMELINE_AUTO},
    {"native", SLUICE_TIMELINE_NATIVE},
    {"binary", SLUICE_TIMELINE_BINARY},
    {"bridged", SLUICE_TIMELINE_BRIDGED},
    {"finish", SLUICE_TIMELINE_FINISH},
    {"unsynchronised", SLUICE_TIMELINE_UNSYNCHRONISED},
}};

}  // namespace

std::span<const FormatInfo> formatTable() {
    return kTable;
}

const FormatInfo* findFormat(std::uint32_t format) {
    return format == SLUICE_FORMAT_NONE || format >= SLUICE_FORMAT_COUNT ? nullptr : &kTable[format - 1];
}

const FormatInfo* findFormat(std::string_view name) {
    const auto* const row = std::ranges::find(kTable, name, &FormatInfo::name);
    return row == kTable.end() ? nullptr : row;
}

std::string_view toString(SluiceImageRole role) {
    switch (role) {
        case SLUICE_IMAGE_HOST_COLOUR:
            return "HOST_COLOUR";
        case SLUICE_IMAGE_HOST_DEPTH:
            return "HOST_DEPTH";
        case SLUICE_IMAGE_FLUID_COLOUR:
            return "FLUID_COLOUR";
        case SLUICE_IMAGE_FLUID_DEPTH:
            return "FLUID_DEPTH";
        case SLUICE_IMAGE_FLUID_NORMAL:
            return "FLUID_NORMAL";
        case SLUICE_IMAGE_FLUID_THICKNESS:
            return "FLUID_THICKNESS";
        case SLUICE_IMAGE_CANARY:
            return "CANARY";
        case SLUICE_IMAGE_ROLE_COUNT:
            break;
    }
    return "unknown role";
}

std::string_view toString(SluiceTimelineKind kind) {
    const auto* const row = std::ranges::find(kTimelineKinds, kind, &NamedKind::kind);
    return row == kTimelineKinds.end() ? "unknown timeline" : row->name;
}

std::optional<SluiceTimelineKind> parseTimelineKind(std::string_view name) {
    const auto* const row = std::ranges::find(kTimelineKinds, name, &NamedKind::name);
    return row == kTimelineKinds.end() ? std::nullopt : std::optional(row->kind);
}

}  // namespace sluice
