// SPDX-License-Identifier: MIT
// The only code of the host that moves pixels to the CPU.
#include <algorithm>
#include <cstddef>

#include "screen/gl_guards.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/screen.hpp"

namespace sluice::host {
namespace {

/// Records one CPU copy from its construction to its destruction.
class CopyRecord {
  public:
    CopyRecord(Trace* trace, const char* name, std::size_t bytes)
        : trace_(trace), name_(name), bytes_(bytes), begin_(trace != nullptr ? monotonicNanoseconds() : 0) {}
    CopyRecord(const CopyRecord&) = delete;
    CopyRecord& operator=(const CopyRecord&) = delete;
    ~CopyRecord() {
        if (trace_ == nullptr) {
            return;
        }
        SluiceTraceEvent event{};
        event.struct_size = sizeof(event);
        event.kind = SLUICE_TRACE_CPU_COPY;
        event.track = SLUICE_TRACK_HOST_CPU;
        event.begin_ns = begin_;
        event.duration_ns = monotonicNanoseconds() - begin_;
        event.bytes = bytes_;
        event.name = name_;
        trace_->record(event);
    }

  private:
    Trace* trace_;
    const char* name_;
    std::size_t bytes_;
    std::uint64_t begin_;
};

/// Rows from the bottom up, as GL has them, become rows from the top down.
template <typename T, typename Convert>
Pixels flipped(const std::vector<T>& source, std::uint32_t width, std::uint32_t height, std::uint32_t channels,
               Convert convert) {
    Pixels pixels{width, height, channels, std::vector<float>(std::size_t{width} * height * channels)};
    const std::size_t row = std::size_t{width} * channels;
    for (std::uint32_t y = 0; y < height; ++y) {
        const auto from = source.begin() + static_cast<std::ptrdiff_t>(row * (height - 1 - y));
        std::transform(from, from + static_cast<std::ptrdiff_t>(row),
                       pixels.values.begin() + static_cast<std::ptrdiff_t>(row * y), convert);
    }
    return pixels;
}

float identity(float value) {
    return value;
}

template <typename T>
std::vector<T> readScreen(const Screen& screen, GLenum format, GLenum type, std::uint32_t channels) {
    std::vector<T> values(std::size_t{screen.width()} * screen.height() * channels);
    const FramebufferGuard framebuffer;
    const PixelGuard pixels;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, screen.framebuffer());
    // The read buffer is the framebuffer's own state, and a caller may have deselected it.
    GLint read_buffer = GL_NONE;
    glGetIntegerv(GL_READ_BUFFER, &read_buffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, static_cast<GLsizei>(screen.width()), static_cast<GLsizei>(screen.height()), format, type,
                 values.data());
    glReadBuffer(static_cast<GLenum>(read_buffer));
    return values;
}

template <typename T>
std::vector<T> readLevel(std::uint32_t texture, GLenum format, GLenum type, std::size_t count) {
    std::vector<T> values(count);
    const TextureGuard binding;
    const PixelGuard pixels;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetTexImage(GL_TEXTURE_2D, 0, format, type, values.data());
    return values;
}

/// Depth, then stencil where the format table counts it as a channel.
Pixels readDepthStencil(std::uint32_t texture, std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
    constexpr float kDepthMax = 16777215.0F;  // 2^24 - 1
    const auto packed =
        readLevel<std::uint32_t>(texture, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, std::size_t{width} * height);
    std::vector<float> values;
    values.reserve(packed.size() * channels);
    for (const std::uint32_t texel : packed) {
        values.push_back(static_cast<float>(texel >> 8U) / kDepthMax);
        if (channels > 1) {
            values.push_back(static_cast<float>(texel & 0xFFU));
        }
    }
    return flipped(values, width, height, channels, identity);
}

}  // namespace

Pixels readColour(const Screen& screen, Trace* trace) {
    constexpr std::uint32_t kChannels = 4;
    const CopyRecord record(trace, "read colour", std::size_t{screen.width()} * screen.height() * kChannels);
    return flipped(readScreen<std::uint8_t>(screen, GL_RGBA, GL_UNSIGNED_BYTE, kChannels), screen.width(),
                   screen.height(), kChannels, [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; });
}

Pixels readDepth(const Screen& screen, Trace* trace) {
    const CopyRecord record(trace, "read depth", std::size_t{screen.width()} * screen.height() * sizeof(float));
    return flipped(readScreen<float>(screen, GL_DEPTH_COMPONENT, GL_FLOAT, 1), screen.width(), screen.height(), 1,
                   identity);
}

Pixels readTexture(std::uint32_t texture, SluiceFormat format, std::uint32_t width, std::uint32_t height,
                   Trace* trace) {
    const FormatInfo* info = findFormat(static_cast<std::uint32_t>(format));
    if (info == nullptr || texture == 0) {
        return {};
    }
    const std::size_t count = std::size_t{width} * height * info->channels;
    const bool packed = info->kind == TexelKind::DepthStencil;
    const CopyRecord record(trace, "read texture",
                            packed ? std::size_t{width} * height * sizeof(std::uint32_t) : count * sizeof(float));
    if (packed) {
        return readDepthStencil(texture, width, height, info->channels);
    }
    if (info->kind == TexelKind::UnsignedInteger) {
        return flipped(readLevel<std::uint32_t>(texture, info->gl_transfer_format, GL_UNSIGNED_INT, count), width,
                       height, info->channels, [](std::uint32_t value) { return static_cast<float>(value); });
    }
    return flipped(readLevel<float>(texture, info->gl_transfer_format, GL_FLOAT, count), width, height, info->channels,
                   identity);
}

}  // namespace sluice::host
