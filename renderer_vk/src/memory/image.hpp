// SPDX-License-Identifier: MIT
// A 2-D image with its own memory and view, exportable to OpenGL when asked for.
#pragma once

#include <volk.h>

#include <cstdint>

#include "device/device.hpp"
#include "frame/pass_context.hpp"
#include "sluice/fd.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

struct ImageDesc {
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t width = 0, height = 0;
    VkImageUsageFlags usage = 0;
    bool exportable = false;  ///< dedicated allocation, exportable as an opaque fd
    const char* name = "";    ///< for debugging tools
};

/// Optimal tiling, one mip, one layer, one sample, bound at offset 0 of its own allocation, layout UNDEFINED at first.
/// Move-only; must die before its Device, and only when no submitted work uses it.
class Image {
  public:
    static Result<Image> create(const Device& device, const ImageDesc& desc);

    Image() = default;
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image();

    [[nodiscard]] VkImage image() const { return image_; }
    /// The whole image; depth formats show their depth aspect. Null if no usage needs a view (transfer only).
    [[nodiscard]] VkImageView view() const { return view_; }
    [[nodiscard]] VkFormat format() const { return format_; }
    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    [[nodiscard]] VkDeviceSize allocationSize() const { return allocation_size_; }
    [[nodiscard]] VkImageAspectFlags aspect() const;
    [[nodiscard]] bool exportable() const { return exportable_; }
    [[nodiscard]] explicit operator bool() const { return image_ != VK_NULL_HANDLE; }
    [[nodiscard]] ImageRef ref() const { return {image_, view_, format_, width_, height_}; }

    /// A new opaque fd of the memory; the caller's. Only for exportable images.
    [[nodiscard]] Result<UniqueFd> exportFd() const;

  private:
    void reset();

    const Device* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize allocation_size_ = 0;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    std::uint32_t width_ = 0, height_ = 0;
    bool exportable_ = false;
};

/// DEPTH, DEPTH|STENCIL or COLOR, by format.
[[nodiscard]] VkImageAspectFlags aspectOf(VkFormat format);

}  // namespace sluice::vk
