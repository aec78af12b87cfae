// SPDX-License-Identifier: MIT
// One slot in OpenGL: a texture with the framebuffer to draw into it, or a buffer.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "share/imported_image.hpp"
#include "sluice/result.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

/// Pinned; freed with the context current.
class GlSlot {
  public:
    /// Of memory that Vulkan exported, or with `exported` null of OpenGL's own.
    [[nodiscard]] static Result<std::unique_ptr<GlSlot>> create(const Storage& storage, std::uint32_t slot,
                                                                ExportedSlot* exported);
    GlSlot() = default;
    GlSlot(const GlSlot&) = delete;
    GlSlot& operator=(const GlSlot&) = delete;
    ~GlSlot();

    [[nodiscard]] std::uint32_t texture() const { return imported_ ? imported_->texture() : texture_; }
    [[nodiscard]] std::uint32_t framebuffer() const { return framebuffer_; }
    [[nodiscard]] std::uint32_t buffer() const { return buffer_; }

  private:
    [[nodiscard]] Status createTexture(const Storage& storage, std::uint32_t slot, ExportedSlot* exported);
    [[nodiscard]] Status createBuffer(const Storage& storage, ExportedSlot* exported);

    std::optional<host::ImportedImage> imported_;
    std::uint32_t texture_ = 0, framebuffer_ = 0, buffer_ = 0, memory_ = 0;
};

/// The row of sluice's format table for an image resource.
[[nodiscard]] SluiceFormat formatFor(Resource resource);

}  // namespace sluice::stress
