// SPDX-License-Identifier: MIT
#include "frame/shared_images.hpp"

#include <fmt/format.h>

#include <limits>

#include "device/capabilities.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"
#include "sluice/export_mark.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {
namespace {

/// What an image holds before its first frame: black without coverage, depth as far as it goes, no thickness.
VkClearColorValue initialColour(SluiceImageRole role, SluiceDepthEncoding encoding) {
    VkClearColorValue value{};
    if (role == SLUICE_IMAGE_FLUID_DEPTH) {
        value.float32[0] = 1.0F;
    } else if (role == SLUICE_IMAGE_HOST_DEPTH) {
        value.float32[0] = encoding == SLUICE_DEPTH_LINEAR ? std::numeric_limits<float>::infinity() : 1.0F;
    }
    return value;
}

void recordClear(const Device& device, VkCommandBuffer commands, const Image& image, SluiceImageRole role,
                 SluiceDepthEncoding encoding) {
    fullBarrier(device, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    const VkImageSubresourceRange range{image.aspect(), 0, 1, 0, 1};
    if (image.aspect() == VK_IMAGE_ASPECT_COLOR_BIT) {
        const VkClearColorValue value = initialColour(role, encoding);
        device.fn.vkCmdClearColorImage(commands, image.image(), VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
    } else {
        const VkClearDepthStencilValue value{1.0F, 0};
        device.fn.vkCmdClearDepthStencilImage(commands, image.image(), VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
    }
    fullBarrier(device, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL,
                device.queue_family, VK_QUEUE_FAMILY_EXTERNAL);
}

}  // namespace

Error hostError(SluiceResult result, const SluiceError& error, std::string_view thing) {
    const bool told = error.message[0] != '\0';
    return {result < 0 ? result : SLUICE_ERROR_INTERNAL, std::string(thing),
            told ? std::string(error.message, strnlen(error.message, sizeof(error.message)))
                 : fmt::format("the host answered {}", static_cast<int>(result)),
            ""};
}

Result<SluiceImageExport> describeExport(const Image& image, SluiceFormat format, SluiceImageRole role,
                                         std::uint32_t set, UniqueFd& fd) {
    Result<UniqueFd> exported = image.exportFd();
    if (!exported) {
        return exported.error();
    }
    fd = std::move(exported).value();
    SluiceImageExport out{};
    out.struct_size = sizeof(out);
    out.role = static_cast<std::uint32_t>(role);
    out.image_set = set;
    out.format = static_cast<std::uint32_t>(format);
    out.width = image.width();
    out.height = image.height();
    out.allocation_size = image.allocationSize();
    out.fd = fd.get();
    out.dedicated = 1;
    return out;
}

SharedImages::SharedImages(const Device& device, const SluiceHostServices& host, const SharedImagesDesc& desc)
    : device_(device), host_(host), desc_(desc), sets_(desc.sets), shared_(desc.sets) {}

Result<std::unique_ptr<SharedImages>> SharedImages::create(const Device& device, const SluiceHostServices& host,
                                                           const SharedImagesDesc& desc) {
    auto images = std::make_unique<SharedImages>(device, host, desc);
    if (Status status = images->allocate(); !status) {
        return status.error();
    }
    if (Status status = images->clear(); !status) {
        return status.error();
    }
    for (std::uint32_t set = 0; set < desc.sets; ++set) {
        for (std::uint32_t role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
            if (Status status = images->share(set, static_cast<SluiceImageRole>(role)); !status) {
                return status.error();
            }
        }
    }
    return images;
}

SharedImages::~SharedImages() {
    retire();
}

void SharedImages::retire() {
    for (std::uint32_t set = 0; set < desc_.sets; ++set) {
        for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
            if (shared_[set][role]) {
                host_.retire_image(host_.user, role, set);
                shared_[set][role] = false;
            }
        }
    }
}

Status SharedImages::allocate() {
    for (std::uint32_t set = 0; set < desc_.sets; ++set) {
        for (std::uint32_t role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
            const FormatInfo* format = findFormat(desc_.formats[role]);
            if (format == nullptr) {
                continue;
            }
            const std::string name = fmt::format("{}[{}]", toString(static_cast<SluiceImageRole>(role)), set);
            Result<Image> image = Image::create(
                device_, {static_cast<VkFormat>(format->vk_format), desc_.width, desc_.height,
                          sharedUsage(device_.instance_fn, device_.physical, format->format), true, name.c_str()});
            if (!image) {
                return image.error();
            }
            sets_[set][role] = std::move(image).value();
        }
    }
    return {};
}

Status SharedImages::clear() const {
    return runOnce(device_, [this](VkCommandBuffer commands) {
        for (const auto& set : sets_) {
            for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
                if (set[role]) {
                    recordClear(device_, commands, set[role], static_cast<SluiceImageRole>(role),
                                desc_.host_depth_encoding);
                }
            }
        }
    });
}

Status SharedImages::share(std::uint32_t set, SluiceImageRole role) {
    if (!sets_[set][role]) {
        return {};
    }
    UniqueFd fd;
    Result<SluiceImageExport> image = describeExport(sets_[set][role], desc_.formats[role], role, set, fd);
    if (!image) {
        return image.error();
    }
    SluiceError error{};
    error.struct_size = sizeof(error);
    markExport(host_, image.value());
    const SluiceResult result = host_.share_image(host_.user, &image.value(), &error);
    if (result != SLUICE_OK) {
        return hostError(result, error, fmt::format("share_image of {}[{}]", toString(role), set));
    }
    (void)fd.release();  // the host's now
    shared_[set][role] = true;
    return {};
}

FrameTargets SharedImages::targets(std::uint32_t set) const {
    const auto& images = sets_[set];
    FrameTargets out;
    out.host_colour = images[SLUICE_IMAGE_HOST_COLOUR].ref();
    out.host_depth = images[SLUICE_IMAGE_HOST_DEPTH].ref();
    out.fluid_colour = images[SLUICE_IMAGE_FLUID_COLOUR].ref();
    out.fluid_depth = images[SLUICE_IMAGE_FLUID_DEPTH].ref();
    out.fluid_normal = images[SLUICE_IMAGE_FLUID_NORMAL].ref();
    out.fluid_thickness = images[SLUICE_IMAGE_FLUID_THICKNESS].ref();
    out.host_depth_encoding = desc_.host_depth_encoding;
    return out;
}

void SharedImages::recordAcquire(VkCommandBuffer commands, std::uint32_t set) const {
    recordTransfer(commands, set, true);
}

void SharedImages::recordRelease(VkCommandBuffer commands, std::uint32_t set) const {
    recordTransfer(commands, set, false);
}

void SharedImages::recordTransfer(VkCommandBuffer commands, std::uint32_t set, bool acquire) const {
    std::array<VkImageMemoryBarrier2, SLUICE_IMAGE_ROLE_COUNT> barriers{};
    std::uint32_t count = 0;
    for (const Image& image : sets_[set]) {
        if (!image) {
            continue;
        }
        auto barrier = vkStruct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
        // The semaphores of the submission do the ordering on the host's side of each transfer; ALL_COMMANDS here
        // chains with their stage mask.
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.srcAccessMask = acquire ? VK_ACCESS_2_NONE : VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.dstAccessMask = acquire ? VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT : VK_ACCESS_2_NONE;
        barrier.oldLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.srcQueueFamilyIndex = acquire ? VK_QUEUE_FAMILY_EXTERNAL : device_.queue_family;
        barrier.dstQueueFamilyIndex = acquire ? device_.queue_family : VK_QUEUE_FAMILY_EXTERNAL;
        barrier.image = image.image();
        barrier.subresourceRange = {image.aspect(), 0, 1, 0, 1};
        barriers[count++] = barrier;
    }
    auto dependency = vkStruct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.imageMemoryBarrierCount = count;
    dependency.pImageMemoryBarriers = barriers.data();
    device_.fn.vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace sluice::vk
