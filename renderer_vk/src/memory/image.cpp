// SPDX-License-Identifier: MIT
#include "memory/image.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "device/capabilities.hpp"
#include "device/exported_fd.hpp"
#include "device/structs.hpp"

namespace sluice::vk {
namespace {

constexpr VkImageUsageFlags kViewable = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;

std::string label(const ImageDesc& desc) {
    return fmt::format("image '{}' {}x{} (VkFormat {})", desc.name, desc.width, desc.height,
                       static_cast<int>(desc.format));
}

}  // namespace

VkImageAspectFlags aspectOf(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D32_SFLOAT:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        case VK_FORMAT_D24_UNORM_S8_UINT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
            return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

Result<Image> Image::create(const Device& device, const ImageDesc& desc) {
    Image out;
    out.device_ = &device;
    out.format_ = desc.format;
    out.width_ = desc.width;
    out.height_ = desc.height;
    out.exportable_ = desc.exportable;

    auto external = vkStruct<VkExternalMemoryImageCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO);
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    auto info = vkStruct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    if (desc.exportable) {
        info.pNext = &external;
        info.flags = sharedFlags(desc.format);
    }
    if (const VkResult result = device.fn.vkCreateImage(device.handle, &info, nullptr, &out.image_);
        result != VK_SUCCESS) {
        return vulkanError(result, label(desc));
    }
    device.name(VK_OBJECT_TYPE_IMAGE, out.image_, desc.name);

    VkMemoryRequirements needs{};
    device.fn.vkGetImageMemoryRequirements(device.handle, out.image_, &needs);
    Result<std::uint32_t> type = device.memoryType(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (!type) {
        return type.error();
    }
    auto dedicated = vkStruct<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
    dedicated.image = out.image_;
    auto exported = vkStruct<VkExportMemoryAllocateInfo>(VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO);
    exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    exported.pNext = &dedicated;
    auto allocation = vkStruct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = type.value();
    if (desc.exportable) {
        allocation.pNext = &exported;
    }
    if (const VkResult result = device.fn.vkAllocateMemory(device.handle, &allocation, nullptr, &out.memory_);
        result != VK_SUCCESS) {
        return vulkanError(result, fmt::format("memory of {}, {} bytes", label(desc), needs.size));
    }
    out.allocation_size_ = needs.size;
    // Offset 0 of its own allocation: llvmpipe ignores the offset of an import, and images would silently alias.
    if (const VkResult result = device.fn.vkBindImageMemory(device.handle, out.image_, out.memory_, 0);
        result != VK_SUCCESS) {
        return vulkanError(result, label(desc));
    }
    if ((desc.usage & kViewable) != 0) {
        auto view = vkStruct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
        view.image = out.image_;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = desc.format;
        view.subresourceRange = {aspectOf(desc.format) & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT}, 0, 1, 0, 1};
        if (const VkResult result = device.fn.vkCreateImageView(device.handle, &view, nullptr, &out.view_);
            result != VK_SUCCESS) {
            return vulkanError(result, "view of " + label(desc));
        }
        device.name(VK_OBJECT_TYPE_IMAGE_VIEW, out.view_, desc.name);
    }
    return out;
}

Image::Image(Image&& other) noexcept {
    *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
    if (this != &other) {
        reset();
        device_ = std::exchange(other.device_, nullptr);
        image_ = std::exchange(other.image_, VK_NULL_HANDLE);
        view_ = std::exchange(other.view_, VK_NULL_HANDLE);
        memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
        allocation_size_ = std::exchange(other.allocation_size_, 0);
        format_ = std::exchange(other.format_, VK_FORMAT_UNDEFINED);
        width_ = std::exchange(other.width_, 0);
        height_ = std::exchange(other.height_, 0);
        exportable_ = std::exchange(other.exportable_, false);
    }
    return *this;
}

Image::~Image() {
    reset();
}

void Image::reset() {
    if (device_ == nullptr) {
        return;
    }
    device_->fn.vkDestroyImageView(device_->handle, view_, nullptr);
    device_->fn.vkDestroyImage(device_->handle, image_, nullptr);
    device_->fn.vkFreeMemory(device_->handle, memory_, nullptr);
    device_ = nullptr;
    image_ = VK_NULL_HANDLE;
    view_ = VK_NULL_HANDLE;
    memory_ = VK_NULL_HANDLE;
}

VkImageAspectFlags Image::aspect() const {
    return aspectOf(format_);
}

Result<UniqueFd> Image::exportFd() const {
    if (!exportable_) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "image", "it was not created exportable", ""};
    }
    auto info = vkStruct<VkMemoryGetFdInfoKHR>(VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR);
    info.memory = memory_;
    info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    // Before the call: should memory run out here, nobody would close the descriptor.
    const std::string call = fmt::format("vkGetMemoryFdKHR of a {}x{} image", width_, height_);
    int fd = -1;
    const VkResult result = device_->fn.vkGetMemoryFdKHR(device_->handle, &info, &fd);
    return exportedFd(result, fd, call);
}

}  // namespace sluice::vk
