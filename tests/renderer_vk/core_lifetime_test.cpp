// SPDX-License-Identifier: MIT
// Create, resize and destroy: what the host holds, which descriptors stay open, and that nothing hangs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>

#include "core_fake_host.hpp"
#include "memory/image.hpp"
#include "sluice/format.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(Lifetime, CreateSharesEveryRoleOfEverySetAndDestroyTakesThemBack) {
    FakeHost host;
    SluiceCreateInfo info = host.createInfo();
    info.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL);
    info.image_sets = 3;
    TestRenderer renderer(host, info);
    ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
    auto found = sized<SluiceRendererInfo>();
    ASSERT_EQ(api().info(renderer.get(), &found), SLUICE_OK);
    EXPECT_EQ(found.timeline, std::uint32_t{SLUICE_TIMELINE_BRIDGED});
    EXPECT_EQ(found.image_sets, 3U);
    EXPECT_EQ(found.width, 64U);
    EXPECT_EQ(found.formats[SLUICE_IMAGE_FLUID_THICKNESS], std::uint32_t{SLUICE_FORMAT_NONE}) << "not asked for";
    ASSERT_EQ(host.held().size(), 15U) << "host colour and depth, fluid colour, depth and normal; 3 sets";
    for (const auto& [key, image] : host.held()) {
        EXPECT_EQ(image.format, found.formats[image.role]);
        EXPECT_EQ(image.width, 64U);
        EXPECT_EQ(image.height, 48U);
        EXPECT_EQ(image.dedicated, 1U);
        EXPECT_GE(image.allocation_size, std::uint64_t{64 * 48} * findFormat(image.format)->bytes_per_texel);
    }
    renderer.destroy();
    EXPECT_TRUE(host.held().empty());
}

TEST(Lifetime, FiftyCyclesLeaveNoDescriptorOpen) {
    FakeHost host;
    const SluiceCreateInfo info = host.createInfo();
    {
        const TestRenderer warm_up(host, info);  // what the loader and the driver open once
        ASSERT_EQ(warm_up.result(), SLUICE_OK) << warm_up.error().message;
    }
    const std::size_t before = openDescriptors();
    for (int i = 0; i < 50; ++i) {
        TestRenderer renderer(host, info);
        ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
        ASSERT_EQ(api().resize(renderer.get(), 31 + static_cast<std::uint32_t>(i), 17, nullptr), SLUICE_OK);
        renderer.destroy();
        ASSERT_EQ(openDescriptors(), before) << "after cycle " << i;
    }
    EXPECT_TRUE(host.held().empty());
}

TEST(Lifetime, ResizeReplacesEveryImage) {
    FakeHost host;
    TestRenderer renderer(host, host.createInfo());
    ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
    auto error = sized<SluiceError>();
    ASSERT_EQ(api().resize(renderer.get(), 129, 33, &error), SLUICE_OK) << error.message;
    EXPECT_EQ(host.held().size(), 8U);
    for (const auto& [key, image] : host.held()) {
        EXPECT_EQ(image.width, 129U);
        EXPECT_EQ(image.height, 33U);
    }
    auto found = sized<SluiceRendererInfo>();
    ASSERT_EQ(api().info(renderer.get(), &found), SLUICE_OK);
    EXPECT_EQ(found.width, 129U);
}

TEST(Lifetime, AShareThatFailsLeavesNothingBehind) {
    FakeHost host;
    const SluiceCreateInfo info = host.createInfo();
    for (int nth = 0; nth < 8; ++nth) {
        host.shares = 0;
        host.fail_share_after = nth;
        const std::size_t before = openDescriptors();
        const TestRenderer renderer(host, info);
        EXPECT_EQ(renderer.result(), SLUICE_ERROR_IMPORT);
        EXPECT_EQ(renderer.get(), nullptr);
        EXPECT_THAT(renderer.error().message, HasSubstr("told to fail"));
        EXPECT_TRUE(host.held().empty()) << nth;
        EXPECT_EQ(openDescriptors(), before);
    }
}

TEST(Lifetime, AfterAFailedResizeOnlyResizeAndDestroyWork) {
    FakeHost host;
    TestRenderer renderer(host, host.createInfo());
    ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
    host.fail_share_after = host.shares + 3;
    EXPECT_EQ(api().resize(renderer.get(), 80, 60, nullptr), SLUICE_ERROR_IMPORT);
    EXPECT_TRUE(host.held().empty());
    EXPECT_EQ(renderer.submit(frameOf(1, 2)), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(renderer.error().message, HasSubstr("resize"));
    host.fail_share_after = -1;
    EXPECT_EQ(api().resize(renderer.get(), 80, 60, nullptr), SLUICE_OK);
    ASSERT_EQ(api().timeline_signal(renderer.get(), 3), SLUICE_OK);
    EXPECT_EQ(renderer.submit(frameOf(2, 2)), SLUICE_OK) << renderer.error().message;
}

TEST(Lifetime, AResizeToAnImpossibleSizeChangesNothing) {
    FakeHost host;
    TestRenderer renderer(host, host.createInfo());
    ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
    for (const auto& [width, height] :
         {std::pair{0U, 60U}, std::pair{80U, 0U}, std::pair{SLUICE_MAX_EXTENT + 1, 60U}}) {
        EXPECT_EQ(api().resize(renderer.get(), width, height, nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    EXPECT_EQ(host.held().size(), 8U);
    EXPECT_EQ(host.shares, 8);
    ASSERT_EQ(api().timeline_signal(renderer.get(), 1), SLUICE_OK);
    EXPECT_EQ(renderer.submit(frameOf(1, 2)), SLUICE_OK) << renderer.error().message;
}

TEST(Lifetime, RunningOutOfDescriptorsNamesTheLimit) {
    DeviceRequest request;
    request.match_host = false;
    Result<std::unique_ptr<Device>> device = Device::create(request);
    ASSERT_TRUE(device) << device.error().message();
    Result<Image> image = Image::create(
        *device.value(), {VK_FORMAT_R8G8B8A8_UNORM, 8, 8, VK_IMAGE_USAGE_TRANSFER_DST_BIT, true, "for its descriptor"});
    ASSERT_TRUE(image) << image.error().message();
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    rlimit none = before;
    none.rlim_cur = 0;  // what is open stays open
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
    const Result<UniqueFd> refused = image.value().exportFd();
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    ASSERT_FALSE(refused);
    EXPECT_LT(refused.error().code, 0);
    EXPECT_THAT(refused.error().message(), HasSubstr("ulimit -n"));
    const Result<UniqueFd> again = image.value().exportFd();
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_TRUE(again.value().valid());
}

TEST(Lifetime, AFormatWhoseCanaryFailsIsStruckAndTheNextIsTaken) {
    FakeHost host;
    host.fail_canary_formats = formatBit(SLUICE_FORMAT_D32F) | formatBit(SLUICE_FORMAT_RGBA16F);
    const TestRenderer renderer(host, host.createInfo());
    ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
    auto found = sized<SluiceRendererInfo>();
    ASSERT_EQ(api().info(renderer.get(), &found), SLUICE_OK);
    EXPECT_EQ(found.formats[SLUICE_IMAGE_HOST_DEPTH], std::uint32_t{SLUICE_FORMAT_R32F});
    EXPECT_EQ(found.host_depth_encoding, std::uint32_t{SLUICE_DEPTH_LINEAR});
    EXPECT_EQ(found.formats[SLUICE_IMAGE_FLUID_COLOUR], std::uint32_t{SLUICE_FORMAT_RGBA8});
    EXPECT_THAT(host.log(), Contains(HasSubstr("told to see wrong texels"))) << "the reason is told";
}

TEST(Lifetime, ACorruptedCanaryIsNoticedByTheRenderer) {
    FakeHost host;
    host.corrupt_canary_formats = formatBit(SLUICE_FORMAT_D32F);
    const TestRenderer renderer(host, host.createInfo());
    ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
    auto found = sized<SluiceRendererInfo>();
    ASSERT_EQ(api().info(renderer.get(), &found), SLUICE_OK);
    EXPECT_EQ(found.formats[SLUICE_IMAGE_HOST_DEPTH], std::uint32_t{SLUICE_FORMAT_R32F});
}

TEST(Lifetime, WithoutAnyProvenFormatCreateFailsAndSaysWhy) {
    FakeHost host;
    host.fail_canary_formats = formatBit(SLUICE_FORMAT_RGBA8);
    const TestRenderer renderer(host, host.createInfo());
    EXPECT_LT(renderer.result(), 0);
    EXPECT_EQ(renderer.get(), nullptr);
    EXPECT_THAT(renderer.error().message, HasSubstr("RGBA8"));
    EXPECT_TRUE(host.held().empty());
}

TEST(Lifetime, DestroyReturnsThoughThePromisedSignalNeverComes) {
    FakeHost host;
    TestRenderer renderer(host, host.createInfo());
    ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message;
    ASSERT_EQ(renderer.submit(frameOf(1, 2)), SLUICE_OK) << renderer.error().message;
    ASSERT_EQ(renderer.submit(frameOf(2, 2)), SLUICE_OK) << renderer.error().message;
    const auto begin = std::chrono::steady_clock::now();
    renderer.destroy();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
    EXPECT_THAT(host.log(), Contains(HasSubstr("never came")));
    EXPECT_TRUE(host.held().empty());
}

TEST(Lifetime, TwoRenderersLiveSideBySide) {
    FakeHost first_host;
    FakeHost second_host;
    TestRenderer first(first_host, first_host.createInfo());
    TestRenderer second(second_host, second_host.createInfo());
    ASSERT_EQ(first.result(), SLUICE_OK);
    ASSERT_EQ(second.result(), SLUICE_OK);
    first.destroy();
    ASSERT_EQ(api().timeline_signal(second.get(), 1), SLUICE_OK);
    ASSERT_EQ(second.submit(frameOf(1, 2)), SLUICE_OK) << second.error().message;
    EXPECT_EQ(api().timeline_wait(second.get(), 1, 20'000'000'000), SLUICE_OK);
}

}  // namespace
}  // namespace sluice::vk::test
