// SPDX-License-Identifier: MIT
// The device of this machine: describe, memory, one-shot commands, proven formats.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "core_fake_host.hpp"
#include "device/one_shot.hpp"
#include "memory/buffer.hpp"
#include "memory/image.hpp"
#include "passes/fluid_recorder.hpp"
#include "sluice/format.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

std::unique_ptr<Device> anyDevice(bool validation = true) {
    DeviceRequest request;
    request.match_host = false;
    request.validation = validation;
    Result<std::unique_ptr<Device>> device = Device::create(request);
    return device ? std::move(device).value() : nullptr;
}

TEST(Device, DescribeFillsWhatNegotiationNeeds) {
    FakeHost host;
    const SluiceCreateInfo info = host.createInfo();
    auto found = sized<SluiceRendererCapabilities>();
    auto error = sized<SluiceError>();
    ASSERT_EQ(api().describe(host.services(), &info, &found, &error), SLUICE_OK) << error.message;
    EXPECT_EQ(found.struct_size, sizeof(found));
    EXPECT_EQ(std::memcmp(found.device_uuid, info.host.device_uuids[0], SLUICE_UUID_SIZE), 0);
    EXPECT_EQ(found.has_external_memory_fd, 1U);
    EXPECT_EQ(found.has_timeline_semaphore, 1U);
    EXPECT_GE(found.queues, 1U);
    EXPECT_NE(found.device_name[0], '\0');
    constexpr std::uint32_t kFrameFormats = (1U << SLUICE_FORMAT_RGBA8) | (1U << SLUICE_FORMAT_RGBA16F) |
                                            (1U << SLUICE_FORMAT_R32F) | (1U << SLUICE_FORMAT_D32F);
    EXPECT_EQ(found.exportable_formats & kFrameFormats, kFrameFormats);
    EXPECT_NE(found.storage_formats & formatBit(SLUICE_FORMAT_R32F), 0U);
    EXPECT_EQ(found.storage_formats & formatBit(SLUICE_FORMAT_D32F), 0U) << "no device stores into depth formats";
}

TEST(Device, DescribeRefusesAForeignHost) {
    FakeHost host;
    SluiceCreateInfo info = host.createInfo();
    info.host.device_uuids[0][0] ^= 0xFFU;
    auto found = sized<SluiceRendererCapabilities>();
    auto error = sized<SluiceError>();
    EXPECT_EQ(api().describe(host.services(), &info, &found, &error), SLUICE_ERROR_DEVICE_MISMATCH);
    EXPECT_EQ(error.code, SLUICE_ERROR_DEVICE_MISMATCH);
    EXPECT_THAT(error.message, HasSubstr("OpenGL has device"));
}

TEST(Device, ImageKeepsItsTexelsWithoutAValidationMessage) {
    const std::unique_ptr<Device> device = anyDevice();
    ASSERT_TRUE(device);
    Result<Image> image = Image::create(
        *device, {VK_FORMAT_R32_SFLOAT, 67, 43,
                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, false,
                  "test"});
    ASSERT_TRUE(image) << image.error().message();
    std::vector<float> texels(67 * 43);
    std::iota(texels.begin(), texels.end(), 0.5F);
    ASSERT_TRUE(uploadImage(*device, image.value(), std::as_bytes(std::span(texels))));
    Result<std::vector<std::byte>> back = downloadImage(*device, image.value(), sizeof(float));
    ASSERT_TRUE(back);
    EXPECT_EQ(std::memcmp(back.value().data(), texels.data(), back.value().size()), 0);
    EXPECT_EQ(device->shared_bytes_by_cpu.load(), 0U) << "it is not a shared image";
    EXPECT_EQ(device->validationMessages(), 0U);
}

TEST(Device, ValidationIsReallyOn) {
    const std::unique_ptr<Device> device = anyDevice();
    ASSERT_TRUE(device);
    // Two writes of one buffer without a barrier: only synchronisation validation sees the hazard.
    Result<Buffer> buffer =
        Buffer::create(*device, {256, VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Device, "hazard"});
    ASSERT_TRUE(buffer);
    ASSERT_TRUE(runOnce(*device, [&](VkCommandBuffer commands) {
        device->fn.vkCmdFillBuffer(commands, buffer.value().buffer(), 0, 256, 1);
        device->fn.vkCmdFillBuffer(commands, buffer.value().buffer(), 0, 256, 2);
    }));
    EXPECT_GE(device->validationMessages(), 1U);
}

TEST(Device, ExportingAnImageThatIsNotExportableFails) {
    const std::unique_ptr<Device> device = anyDevice(false);
    ASSERT_TRUE(device);
    Result<Image> image =
        Image::create(*device, {VK_FORMAT_R32_SFLOAT, 8, 8, VK_IMAGE_USAGE_SAMPLED_BIT, false, "private"});
    ASSERT_TRUE(image);
    EXPECT_FALSE(image.value().exportFd());
}

TEST(Device, HandlesSurviveBeingMoved) {
    const std::unique_ptr<Device> device = anyDevice();
    ASSERT_TRUE(device);
    Result<Buffer> first = Buffer::create(*device, {64, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Upload, "a"});
    Result<Buffer> second = Buffer::create(*device, {128, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Upload, "b"});
    ASSERT_TRUE(first);
    ASSERT_TRUE(second);
    Buffer kept = std::move(first).value();
    kept = std::move(second).value();
    EXPECT_EQ(kept.size(), 128U);
    EXPECT_EQ(kept.mapped().size(), 128U);
    EXPECT_FALSE(first.value());
    EXPECT_FALSE(second.value());
    EXPECT_EQ(device->validationMessages(), 0U);
}

class ProbeFormat : public ::testing::TestWithParam<FormatInfo> {};

TEST_P(ProbeFormat, CrossesBetweenTwoDevicesBothWays) {
    FakeHost host;
    SluiceCreateInfo info = host.createInfo();
    info.validation = 1;
    const std::size_t before = openDescriptors();
    auto error = sized<SluiceError>();
    ASSERT_EQ(api().probe_format(host.services(), &info, GetParam().format, 67, 43, &error), SLUICE_OK)
        << error.message;
    EXPECT_EQ(host.canaries, 1);
    EXPECT_TRUE(host.log().empty()) << host.log().front();
    EXPECT_EQ(openDescriptors(), before);
}

TEST_P(ProbeFormat, AWrongTexelFromTheHostIsFound) {
    FakeHost host;
    const SluiceCreateInfo info = host.createInfo();
    host.corrupt_canary_formats = formatBit(GetParam().format);
    const std::size_t before = openDescriptors();
    auto error = sized<SluiceError>();
    EXPECT_EQ(api().probe_format(host.services(), &info, GetParam().format, 67, 43, &error), SLUICE_ERROR_CANARY);
    EXPECT_NE(error.message[0], '\0');
    EXPECT_EQ(openDescriptors(), before);
}

INSTANTIATE_TEST_SUITE_P(Formats, ProbeFormat, ::testing::ValuesIn(formatTable().begin(), formatTable().end()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Recorder, RefusesADeviceThatCannotBlendTheThickness) {
    const std::unique_ptr<Device> device = anyDevice(false);
    ASSERT_NE(device, nullptr);
    EXPECT_TRUE(FluidRecorder::create(*device));
    device->capabilities.blendable_formats &= ~formatBit(SLUICE_FORMAT_R32F);
    const Result<FluidRecorder> refused = FluidRecorder::create(*device);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, SLUICE_ERROR_UNSUPPORTED);
    EXPECT_NE(refused.error().message().find("R32F"), std::string::npos) << refused.error().message();
}

}  // namespace
}  // namespace sluice::vk::test
