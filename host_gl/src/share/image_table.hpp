// SPDX-License-Identifier: MIT
// The shared images that the host holds, by role and set.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "share/imported_image.hpp"
#include "sluice/plugin.h"

namespace sluice::host {

/// One slot per (role, set). Changed on the GL thread only, with the context current.
class ImageTable {
  public:
    /// Takes `image`; what the slot held before is freed.
    void put(ImportedImage image);
    void retire(std::uint32_t role, std::uint32_t image_set);
    void clear();

    /// nullptr if the slot is empty or not of this table.
    [[nodiscard]] const ImportedImage* find(std::uint32_t role, std::uint32_t image_set) const;
    /// Texture of a slot, 0 if empty.
    [[nodiscard]] std::uint32_t texture(std::uint32_t role, std::uint32_t image_set) const;
    /// Every texture of a set: what a GL semaphore has to name.
    [[nodiscard]] std::vector<std::uint32_t> textures(std::uint32_t image_set) const;
    [[nodiscard]] std::uint32_t count() const;

  private:
    using Set = std::array<ImportedImage, SLUICE_IMAGE_ROLE_COUNT>;
    std::array<Set, SLUICE_MAX_IMAGE_SETS> sets_;
};

}  // namespace sluice::host
