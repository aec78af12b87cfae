// SPDX-License-Identifier: MIT
// The ring of image sets that both sides hold in turn.
#pragma once

#include <volk.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "device/device.hpp"
#include "frame/pass_context.hpp"
#include "memory/image.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

struct SharedImagesDesc {
    std::array<SluiceFormat, SLUICE_IMAGE_ROLE_COUNT> formats{};  ///< NONE: not shared
    SluiceDepthEncoding host_depth_encoding = SLUICE_DEPTH_WINDOW;
    std::uint32_t width = 0, height = 0, sets = 0;
};

/// Every shared image of every set, allocated, cleared and given to the host; taken back from it at the end.
/// Between frames the host holds them: GENERAL layout, owned by VK_QUEUE_FAMILY_EXTERNAL.
class SharedImages {
  public:
    /// Fails without leaving anything with the host.
    static Result<std::unique_ptr<SharedImages>> create(const Device& device, const SluiceHostServices& host,
                                                        const SharedImagesDesc& desc);

    SharedImages(const Device& device, const SluiceHostServices& host, const SharedImagesDesc& desc);
    SharedImages(const SharedImages&) = delete;
    SharedImages& operator=(const SharedImages&) = delete;
    /// Retires every image; no submitted frame may be running.
    ~SharedImages();
    /// Takes every image back from the host, once; the memory stays until the end, for frames that still run.
    void retire();

    [[nodiscard]] const SharedImagesDesc& desc() const { return desc_; }
    [[nodiscard]] FrameTargets targets(std::uint32_t set) const;
    /// Image of a role, empty if it is not shared.
    [[nodiscard]] const Image& image(std::uint32_t set, SluiceImageRole role) const { return sets_[set][role]; }

    /// Takes the images of a set from the host: after the wait for its signal, before the first pass.
    void recordAcquire(VkCommandBuffer commands, std::uint32_t set) const;
    /// Gives them back: after the last pass.
    void recordRelease(VkCommandBuffer commands, std::uint32_t set) const;

  private:
    [[nodiscard]] Status allocate();
    [[nodiscard]] Status clear() const;
    [[nodiscard]] Status share(std::uint32_t set, SluiceImageRole role);
    void recordTransfer(VkCommandBuffer commands, std::uint32_t set, bool acquire) const;

    const Device& device_;
    const SluiceHostServices& host_;
    SharedImagesDesc desc_;
    std::vector<std::array<Image, SLUICE_IMAGE_ROLE_COUNT>> sets_;
    std::vector<std::array<bool, SLUICE_IMAGE_ROLE_COUNT>> shared_;
};

/// Exports `image` and fills what the host is told about it; the fd is in `fd` as well and still ours.
[[nodiscard]] Result<SluiceImageExport> describeExport(const Image& image, SluiceFormat format, SluiceImageRole role,
                                                       std::uint32_t set, UniqueFd& fd);

/// A host service's failure as an Error: its message if it gave one.
[[nodiscard]] Error hostError(SluiceResult result, const SluiceError& error, std::string_view thing);

}  // namespace sluice::vk
