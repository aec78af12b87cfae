// SPDX-License-Identifier: MIT
#include "core_fake_host.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <span>

#include "device/capabilities.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"
#include "memory/buffer.hpp"
#include "plugin/prove.hpp"
#include "sluice/canary.hpp"
#include "sluice/fd.hpp"
#include "sluice/format.hpp"
#include "sluice/timeline.hpp"

namespace sluice::vk::test {
namespace {

/// A foreign image on the host's device. On success the fd belongs to Vulkan.
struct Imported {
    const Device& device;
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;

    explicit Imported(const Device& owner) : device(owner) {}
    Imported(const Imported&) = delete;
    Imported& operator=(const Imported&) = delete;
    ~Imported() {
        device.fn.vkDestroyImage(device.handle, image, nullptr);
        device.fn.vkFreeMemory(device.handle, memory, nullptr);
    }

    bool import(const SluiceImageExport& from) {
        const FormatInfo* row = findFormat(from.format);
        const auto format = static_cast<VkFormat>(row->vk_format);
        auto external = vkStruct<VkExternalMemoryImageCreateInfo>(VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_IMAGE_CREATE_INFO);
        external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        auto info = vkStruct<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
        info.pNext = &external;
        info.flags = sharedFlags(format);
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {from.width, from.height, 1};
        info.mipLevels = 1;
        info.arrayLayers = 1;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = sharedUsage(device.instance_fn, device.physical, row->format);
        if (device.fn.vkCreateImage(device.handle, &info, nullptr, &image) != VK_SUCCESS) {
            return false;
        }
        VkMemoryRequirements needs{};
        device.fn.vkGetImageMemoryRequirements(device.handle, image, &needs);
        Result<std::uint32_t> type = device.memoryType(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        auto dedicated = vkStruct<VkMemoryDedicatedAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO);
        dedicated.image = image;
        auto imported = vkStruct<VkImportMemoryFdInfoKHR>(VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR);
        imported.pNext = &dedicated;
        imported.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
        // A duplicate: the import takes the descriptor, but on failure the renderer's must still be the renderer's.
        UniqueFd duplicate(::dup(from.fd));
        imported.fd = duplicate.get();
        auto allocation = vkStruct<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
        allocation.pNext = &imported;
        allocation.allocationSize = from.allocation_size;
        allocation.memoryTypeIndex = type ? type.value() : 0;
        if (device.fn.vkAllocateMemory(device.handle, &allocation, nullptr, &memory) != VK_SUCCESS) {
            return false;
        }
        (void)duplicate.release();
        return device.fn.vkBindImageMemory(device.handle, image, memory, 0) == VK_SUCCESS;
    }

    /// Copies between the image and a buffer of its own, whole, through GENERAL.
    Status copy(std::vector<std::byte>& texels, const SluiceImageExport& from, bool write) const {
        Result<Buffer> staging =
            Buffer::create(device, {texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                    BufferPlace::Readback, "fake host"});
        if (!staging) {
            return staging.error();
        }
        if (write) {
            std::memcpy(staging.value().mapped().data(), texels.data(), texels.size());
        }
        const VkImageAspectFlags aspect = aspectOf(static_cast<VkFormat>(findFormat(from.format)->vk_format));
        VkBufferImageCopy region{};
        region.imageSubresource = {aspect & ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT}, 0, 0, 1};
        region.imageExtent = {from.width, from.height, 1};
        const VkBuffer buffer = staging.value().buffer();
        Status status = runOnce(device, [&](VkCommandBuffer commands) {
            fullBarrier(device, commands, image, aspect, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL,
                        VK_QUEUE_FAMILY_EXTERNAL, device.queue_family);
            if (write) {
                device.fn.vkCmdCopyBufferToImage(commands, buffer, image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
            } else {
                device.fn.vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_GENERAL, buffer, 1, &region);
            }
            fullBarrier(device, commands, image, aspect, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL,
                        device.queue_family, VK_QUEUE_FAMILY_EXTERNAL);
        });
        if (status && !write) {
            std::memcpy(texels.data(), staging.value().mapped().data(), texels.size());
        }
        return status;
    }
};

void say(SluiceError* error, SluiceResult code, const std::string& text) {
    error->code = code;
    std::snprintf(error->message, sizeof(error->message), "%s", text.c_str());
}

}  // namespace

FakeHost::FakeHost(bool tracing) {
    services_.struct_size = sizeof(services_);
    services_.abi_version = SLUICE_ABI_VERSION;
    services_.user = this;
    services_.log = onLog;
    services_.trace = tracing ? onTrace : nullptr;
    services_.share_image = onShare;
    services_.retire_image = onRetire;
    services_.canary = onCanary;
    DeviceRequest request;
    request.match_host = false;
    Result<std::unique_ptr<Device>> device = Device::create(request);
    if (device) {
        device_ = std::move(device).value();
    }
}

SluiceCreateInfo FakeHost::createInfo() const {
    SluiceCreateInfo info{};
    info.struct_size = sizeof(info);
    info.width = 64;
    info.height = 48;
    info.image_sets = 2;
    info.timeline = SLUICE_TIMELINE_BRIDGED;
    SluiceHostCapabilities& host = info.host;
    host.struct_size = sizeof(host);
    host.device_uuid_count = 1;
    std::memcpy(host.device_uuids[0], device_->capabilities.device_uuid, SLUICE_UUID_SIZE);
    std::memcpy(host.driver_uuid, device_->capabilities.driver_uuid, SLUICE_UUID_SIZE);
    host.has_memory_object = 1;
    host.has_memory_object_fd = 1;
    host.has_sync = 1;
    host.has_framebuffer_object = 1;
    for (const FormatInfo& row : formatTable()) {
        host.texture_formats |= formatBit(row.format);
        host.attachment_formats |= formatBit(row.format);
    }
    return info;
}

std::vector<SeenEvent> FakeHost::events() const {
    const std::lock_guard guard(lock_);
    return events_;
}

std::vector<std::string> FakeHost::log() const {
    const std::lock_guard guard(lock_);
    return log_;
}

void FakeHost::onLog(void* user, std::int32_t /*level*/, const char* message) {
    auto& self = *static_cast<FakeHost*>(user);
    const std::lock_guard guard(self.lock_);
    self.log_.emplace_back(message);
}

void FakeHost::onTrace(void* user, const SluiceTraceEvent* event) {
    auto& self = *static_cast<FakeHost*>(user);
    const std::lock_guard guard(self.lock_);
    self.events_.push_back({*event, event->name});
}

SluiceResult FakeHost::onShare(void* user, const SluiceImageExport* image, SluiceError* error) {
    auto& self = *static_cast<FakeHost*>(user);
    if (self.fail_share_after >= 0 && self.shares >= self.fail_share_after) {
        say(error, SLUICE_ERROR_IMPORT, "told to fail");
        return SLUICE_ERROR_IMPORT;
    }
    ++self.shares;
    UniqueFd mine(image->fd);
    if (self.keep_descriptors) {
        self.descriptors_[{image->role, image->image_set}] = std::move(mine);
    }
    self.held_[{image->role, image->image_set}] = *image;
    return SLUICE_OK;
}

void FakeHost::onRetire(void* user, std::uint32_t role, std::uint32_t set) {
    static_cast<FakeHost*>(user)->held_.erase({role, set});
    static_cast<FakeHost*>(user)->descriptors_.erase({role, set});
}

std::vector<std::byte> FakeHost::texels(SluiceImageRole role, std::uint32_t set) const {
    const auto kept = descriptors_.find({role, set});
    if (kept == descriptors_.end()) {
        return {};
    }
    SluiceImageExport image = held_.at({role, set});
    image.fd = kept->second.get();
    Imported mine(*device_);
    std::vector<std::byte> out(std::size_t{image.width} * image.height * findFormat(image.format)->bytes_per_texel);
    return mine.import(image) && mine.copy(out, image, false) ? out : std::vector<std::byte>{};
}

bool FakeHost::fill(SluiceImageRole role, std::uint32_t set, std::span<const std::byte> texels) const {
    const auto kept = descriptors_.find({role, set});
    if (kept == descriptors_.end()) {
        return false;
    }
    SluiceImageExport image = held_.at({role, set});
    image.fd = kept->second.get();
    Imported mine(*device_);
    std::vector<std::byte> in(texels.begin(), texels.end());
    return mine.import(image) && mine.copy(in, image, true).ok();
}

SluiceResult FakeHost::onCanary(void* user, const SluiceImageExport* image, std::uint32_t seed, SluiceError* error) {
    auto& self = *static_cast<FakeHost*>(user);
    ++self.canaries;
    const auto format = static_cast<SluiceFormat>(image->format);
    if ((self.fail_canary_formats & formatBit(format)) != 0) {
        say(error, SLUICE_ERROR_CANARY, "told to see wrong texels");
        return SLUICE_ERROR_CANARY;
    }
    Imported mine(*self.device_);
    if (!mine.import(*image)) {
        say(error, SLUICE_ERROR_IMPORT, "vkAllocateMemory refused the fd");
        return SLUICE_ERROR_IMPORT;
    }
    const FormatInfo& row = *findFormat(image->format);
    std::vector<std::byte> texels(std::size_t{image->width} * image->height * row.bytes_per_texel);
    Status status = mine.copy(texels, *image, false);
    if (status) {
        if (format == SLUICE_FORMAT_D24S8) {
            depth24ToGl(texels);
        }
        status = canaryCompare(format, image->width, image->height, seed, texels);
    }
    if (status) {
        texels = canaryPattern(format, image->width, image->height, seed + 1);
        if ((self.corrupt_canary_formats & formatBit(format)) != 0) {
            texels[texels.size() / 2] ^= std::byte{0x10};
        }
        if (format == SLUICE_FORMAT_D24S8) {
            depth24FromGl(texels);
        }
        status = mine.copy(texels, *image, true);
    }
    if (!status) {
        say(error, SLUICE_ERROR_CANARY, status.error().message());
        return SLUICE_ERROR_CANARY;
    }
    ::close(image->fd);
    return SLUICE_OK;
}

TestRenderer::TestRenderer(const FakeHost& host, const SluiceCreateInfo& info) {
    error_.struct_size = sizeof(error_);
    result_ = api().create(host.services(), &info, &renderer_, &error_);
}

void TestRenderer::destroy() {
    api().destroy(renderer_);
    renderer_ = nullptr;
}

SluiceResult TestRenderer::submit(const SluiceFrame& frame) {
    error_ = {};
    error_.struct_size = sizeof(error_);
    return api().submit_frame(renderer_, &frame, &error_);
}

SluiceFrame frameOf(std::uint64_t k, std::uint32_t image_sets, SluiceView view) {
    SluiceFrame frame{};
    frame.struct_size = sizeof(frame);
    frame.frame = k;
    frame.image_set = imageSetOf(k, image_sets);
    frame.wait_value = gbufferWritten(k);
    frame.signal_value = fluidWritten(k);
    constexpr float kNear = 0.1F;
    constexpr float kFar = 10.0F;
    for (const std::size_t i : {0U, 5U, 10U, 15U}) {
        frame.camera.view[i] = 1.0F;
    }
    // A symmetric frustum of 60 degrees, 4:3, as glFrustum defines it.
    const float f = 1.0F / std::tan(30.0F * 3.14159265F / 180.0F);
    frame.camera.projection[0] = f * 3.0F / 4.0F;
    frame.camera.projection[5] = f;
    frame.camera.projection[10] = (kFar + kNear) / (kNear - kFar);
    frame.camera.projection[11] = -1.0F;
    frame.camera.projection[14] = 2.0F * kFar * kNear / (kNear - kFar);
    frame.camera.near_plane = kNear;
    frame.camera.far_plane = kFar;
    frame.sky.zenith[2] = 0.8F;
    frame.sky.horizon[2] = 0.9F;
    frame.sky.to_sun[1] = 1.0F;
    frame.sky.sun_radiance[0] = 10.0F;
    SluiceFluid& fluid = frame.fluid;
    fluid.absorption[0] = 1.0F;
    fluid.absorption[1] = 0.3F;
    fluid.absorption[2] = 0.1F;
    fluid.index_of_refraction = 1.33F;
    fluid.specular_power = 200.0F;
    fluid.splat_radius = 1.5F;
    fluid.filter = SLUICE_FILTER_NARROW_RANGE;
    fluid.filter_iterations = 2;
    fluid.filter_range = 10.0F;
    fluid.filter_clamp = 1.0F;
    fluid.filter_sigma = 1.0F;
    fluid.filter_max_pixels = 16;
    fluid.thickness_scale = 0.5F;
    fluid.thickness_blur = 1.0F;
    fluid.refraction = 1;
    fluid.reflection = 1;
    fluid.view = static_cast<std::uint32_t>(view);
    return frame;
}

ParticleCloud::ParticleCloud(std::uint32_t count) {
    std::minstd_rand random(7);
    std::uniform_real_distribution<float> along(-0.3F, 0.3F);
    position.reserve(std::size_t{3} * count);
    for (std::uint32_t i = 0; i < count; ++i) {
        position.push_back(along(random));
        position.push_back(along(random));
        position.push_back(-2.0F + along(random));
    }
    particles.struct_size = sizeof(particles);
    particles.count = count;
    particles.radius = 0.02F;
    particles.position = position.data();
}

std::size_t openDescriptors() {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        ++count;
    }
    return count;
}

}  // namespace sluice::vk::test
