// SPDX-License-Identifier: MIT
#include "plugin/prove.hpp"

#include <fmt/format.h>

#include <cstring>

#include "device/capabilities.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"
#include "frame/shared_images.hpp"
#include "memory/image.hpp"
#include "sluice/canary.hpp"
#include "sluice/export_mark.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {
namespace {

template <typename Convert>
void eachWord(std::vector<std::byte>& texels, Convert convert) {
    for (std::size_t at = 0; at + sizeof(std::uint32_t) <= texels.size(); at += sizeof(std::uint32_t)) {
        std::uint32_t word = 0;
        std::memcpy(&word, &texels[at], sizeof(word));
        word = convert(word);
        std::memcpy(&texels[at], &word, sizeof(word));
    }
}

void clearStencil(const Device& device, VkCommandBuffer commands, const Image& image) {
    const VkClearDepthStencilValue zero{0.0F, 0};
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_STENCIL_BIT, 0, 1, 0, 1};
    device.fn.vkCmdClearDepthStencilImage(commands, image.image(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &range);
    fullBarrier(device, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
}

Status handOver(const Device& device, const Image& image, bool to_host) {
    return runOnce(device, [&](VkCommandBuffer commands) {
        if (to_host && (image.aspect() & VK_IMAGE_ASPECT_STENCIL_BIT) != 0) {
            clearStencil(device, commands, image);
        }
        fullBarrier(device, commands, image.image(), image.aspect(), VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL,
                    to_host ? device.queue_family : VK_QUEUE_FAMILY_EXTERNAL,
                    to_host ? VK_QUEUE_FAMILY_EXTERNAL : device.queue_family);
    });
}

Status askHost(const SluiceHostServices& host, const Image& image, SluiceFormat format, std::uint32_t seed) {
    UniqueFd fd;
    Result<SluiceImageExport> exported = describeExport(image, format, SLUICE_IMAGE_CANARY, 0, fd);
    if (!exported) {
        return exported.error();
    }
    SluiceError error{};
    error.struct_size = sizeof(error);
    markExport(host, exported.value());
    const SluiceResult result = host.canary(host.user, &exported.value(), seed, &error);
    if (result != SLUICE_OK) {
        return hostError(result, error, "canary on the host");
    }
    (void)fd.release();  // the host's now
    return {};
}

}  // namespace

void depth24FromGl(std::vector<std::byte>& texels) {
    eachWord(texels, [](std::uint32_t word) { return word >> 8U; });
}

void depth24ToGl(std::vector<std::byte>& texels) {
    eachWord(texels, [](std::uint32_t word) { return word << 8U; });
}

Status proveFormat(const Device& device, const SluiceHostServices& host, SluiceFormat format, std::uint32_t width,
                   std::uint32_t height, std::uint32_t seed) {
    const FormatInfo* row = findFormat(format);
    if (row == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "format", fmt::format("{} is none", static_cast<int>(format)), ""};
    }
    if ((device.capabilities.exportable_formats & formatBit(format)) == 0) {
        return Error{SLUICE_ERROR_UNSUPPORTED, std::string(row->name),
                     fmt::format("'{}' cannot export images of it", device.properties.deviceName), ""};
    }
    Result<Image> made =
        Image::create(device, {static_cast<VkFormat>(row->vk_format), width, height,
                               sharedUsage(device.instance_fn, device.physical, format), true, "canary"});
    if (!made) {
        return made.error();
    }
    const Image& image = made.value();
    std::vector<std::byte> pattern = canaryPattern(format, width, height, seed);
    if (format == SLUICE_FORMAT_D24S8) {
        depth24FromGl(pattern);
    }
    if (Status status = uploadImage(device, image, pattern); !status) {
        return status;
    }
    if (Status status = handOver(device, image, true); !status) {
        return status;
    }
    if (Status status = askHost(host, image, format, seed); !status) {
        return status;
    }
    if (Status status = handOver(device, image, false); !status) {
        return status;
    }
    Result<std::vector<std::byte>> found = downloadImage(device, image, row->bytes_per_texel);
    if (!found) {
        return found.error();
    }
    if (format == SLUICE_FORMAT_D24S8) {
        depth24ToGl(found.value());
    }
    return canaryCompare(format, width, height, seed + 1, found.value());
}

}  // namespace sluice::vk
