// SPDX-License-Identifier: MIT
// A texture whose storage is memory that the renderer exported.
#pragma once

#include <cstdint>
#include <utility>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::ledger {
class ShareFeed;
}

namespace sluice::host {

/// Owns a GL texture and the memory object under it. Move-only; freed with the GL context current.
class ImportedImage {
  public:
    ImportedImage() = default;
    ImportedImage(ImportedImage&& other) noexcept { swap(other); }
    ImportedImage& operator=(ImportedImage&& other) noexcept {
        swap(other);
        return *this;
    }
    ImportedImage(const ImportedImage&) = delete;
    ImportedImage& operator=(const ImportedImage&) = delete;
    ~ImportedImage();

    [[nodiscard]] std::uint32_t texture() const { return texture_; }
    [[nodiscard]] const SluiceImageExport& description() const { return description_; }
    /// The size that ACQUIRE and RELEASE events carry.
    [[nodiscard]] std::uint64_t bytes() const { return description_.allocation_size; }

  private:
    friend Result<ImportedImage> importImage(const SluiceImageExport& image, ledger::ShareFeed* feed);
    void swap(ImportedImage& other) noexcept {
        std::swap(texture_, other.texture_);
        std::swap(memory_, other.memory_);
        std::swap(description_, other.description_);
    }

    std::uint32_t texture_ = 0, memory_ = 0;
    SluiceImageExport description_{};
};

/// Binds the exported memory to a new texture (nearest, clamped, one level). On success image.fd has been consumed; on
/// failure it is untouched and still the caller's. Leaves bindings as found; clears GL's error flags. `feed` hears of
/// every descriptor and of what GL was told; nullptr: nobody does.
[[nodiscard]] Result<ImportedImage> importImage(const SluiceImageExport& image, ledger::ShareFeed* feed = nullptr);

}  // namespace sluice::host
