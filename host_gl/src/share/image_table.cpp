// SPDX-License-Identifier: MIT
#include "share/image_table.hpp"

#include <utility>

namespace sluice::host {

void ImageTable::put(ImportedImage image) {
    const SluiceImageExport& at = image.description();
    // importImage has checked both indices. The old image dies with `image`, after the swap.
    ImportedImage& slot = sets_.at(at.image_set).at(at.role);
    slot = std::move(image);
}

void ImageTable::retire(std::uint32_t role, std::uint32_t image_set) {
    if (role < SLUICE_IMAGE_ROLE_COUNT && image_set < SLUICE_MAX_IMAGE_SETS) {
        const ImportedImage old = std::exchange(sets_.at(image_set).at(role), ImportedImage{});
    }
}

void ImageTable::clear() {
    for (Set& set : sets_) {
        for (ImportedImage& image : set) {
            const ImportedImage old = std::exchange(image, ImportedImage{});
        }
    }
}

const ImportedImage* ImageTable::find(std::uint32_t role, std::uint32_t image_set) const {
    if (role >= SLUICE_IMAGE_ROLE_COUNT || image_set >= SLUICE_MAX_IMAGE_SETS) {
        return nullptr;
    }
    const ImportedImage& image = sets_.at(image_set).at(role);
    return image.texture() != 0 ? &image : nullptr;
}

std::uint32_t ImageTable::texture(std::uint32_t role, std::uint32_t image_set) const {
    const ImportedImage* image = find(role, image_set);
    return image != nullptr ? image->texture() : 0;
}

std::vector<std::uint32_t> ImageTable::textures(std::uint32_t image_set) const {
    std::vector<std::uint32_t> names;
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        if (const ImportedImage* image = find(role, image_set)) {
            names.push_back(image->texture());
        }
    }
    return names;
}

std::uint32_t ImageTable::count() const {
    std::uint32_t total = 0;
    for (std::uint32_t set = 0; set < SLUICE_MAX_IMAGE_SETS; ++set) {
        total += static_cast<std::uint32_t>(textures(set).size());
    }
    return total;
}

}  // namespace sluice::host
