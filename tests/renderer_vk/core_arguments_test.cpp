// SPDX-License-Identifier: MIT
// Every way of breaking the contract of plugin.h, one by one: INVALID_ARGUMENT with a message, and nothing happens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core_fake_host.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct BadCreate {
    const char* named;
    std::function<void(SluiceCreateInfo&)> damage;
};

TEST(Arguments, CreateNamesTheBadField) {
    FakeHost host;
    const BadCreate cases[] = {
        {"struct_size", [](auto& i) { i.struct_size = sizeof(SluiceCreateInfo) - 1; }},
        {"info.host", [](auto& i) { i.host.struct_size = 8; }},
        {"device_uuid_count", [](auto& i) { i.host.device_uuid_count = SLUICE_MAX_DEVICE_UUIDS + 1; }},
        {"0x48", [](auto& i) { i.width = 0; }},
        {"64x0", [](auto& i) { i.height = 0; }},
        {"16385", [](auto& i) { i.width = 16385; }},
        {"image_sets", [](auto& i) { i.image_sets = 0; }},
        {"image_sets", [](auto& i) { i.image_sets = SLUICE_MAX_IMAGE_SETS + 1; }},
        {"timeline", [](auto& i) { i.timeline = SLUICE_TIMELINE_KIND_COUNT; }},
        {"outputs", [](auto& i) { i.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_COLOUR); }},
        {"host_depth_format", [](auto& i) { i.host_depth_format = SLUICE_FORMAT_COUNT; }},
    };
    for (const BadCreate& test : cases) {
        SluiceCreateInfo info = host.createInfo();
        test.damage(info);
        const TestRenderer renderer(host, info);
        EXPECT_EQ(renderer.result(), SLUICE_ERROR_INVALID_ARGUMENT) << test.named;
        EXPECT_EQ(renderer.get(), nullptr);
        EXPECT_EQ(renderer.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(renderer.error().message, HasSubstr(test.named));
    }
    EXPECT_EQ(host.shares, 0);
}

TEST(Arguments, CreateNeedsServicesThatShare) {
    FakeHost host;
    const SluiceCreateInfo info = host.createInfo();
    host.mutableServices().share_image = nullptr;
    EXPECT_EQ(TestRenderer(host, info).result(), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceRenderer* renderer = nullptr;
    auto error = sized<SluiceError>();
    EXPECT_EQ(api().create(nullptr, &info, &renderer, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().create(host.services(), nullptr, &renderer, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().create(host.services(), &info, nullptr, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().create(host.services(), &info, nullptr, nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
}

TEST(Arguments, AHostOfAnotherMajorIsRefused) {
    FakeHost host;
    host.mutableServices().abi_version = SLUICE_MAKE_ABI(SLUICE_ABI_MAJOR + 1, 0);
    const TestRenderer renderer(host, host.createInfo());
    EXPECT_EQ(renderer.result(), SLUICE_ERROR_ABI_MISMATCH);
    EXPECT_NE(renderer.error().message[0], '\0');
}

TEST(Arguments, AnErrorStructOfAnOlderHostIsNotOverrun) {
    FakeHost host;
    SluiceCreateInfo info = host.createInfo();
    info.width = 0;
    auto error = sized<SluiceError>();
    error.struct_size = 16;  // header and 8 characters
    error.message[8] = '#';
    SluiceRenderer* renderer = nullptr;
    EXPECT_EQ(api().create(host.services(), &info, &renderer, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error.message[7], '\0');
    EXPECT_EQ(error.message[8], '#');
}

TEST(Arguments, NullRenderersAreRefusedAndDestroyIgnoresThem) {
    auto error = sized<SluiceError>();
    std::uint64_t value = 0;
    std::int32_t fd = -1;
    auto info = sized<SluiceRendererInfo>();
    auto stats = sized<SluiceFrameStats>();
    const SluiceFrame frame = frameOf(1, 2);
    const ParticleCloud cloud(3);
    EXPECT_EQ(api().info(nullptr, &info), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().resize(nullptr, 8, 8, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().set_particles(nullptr, &cloud.particles, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().set_environment(nullptr, nullptr, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().submit_frame(nullptr, &frame, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().poll(nullptr, 1, &stats), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().timeline_signal(nullptr, 1), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().timeline_wait(nullptr, 1, 0), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().timeline_value(nullptr, 0, &value), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().timeline_export(nullptr, 0, 0, &fd, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    api().destroy(nullptr);
}

class RendererArguments : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message; }
    FakeHost host;
    TestRenderer renderer{host, host.createInfo()};
};

TEST_F(RendererArguments, BadFramesAreNamedAndTheNextGoodOneRuns) {
    struct BadFrame {
        const char* named;
        std::function<void(SluiceFrame&)> damage;
    };
    const BadFrame cases[] = {
        {"struct_size", [](auto& f) { f.struct_size = kAbiMinimum<SluiceFrame> - 1; }},
        {"frame.frame", [](auto& f) { f.frame = 0; }},
        {"without gaps", [](auto& f) { f.frame = 2; }},
        {"image_set", [](auto& f) { f.image_set = 1; }},
        {"wait_value", [](auto& f) { f.wait_value = 2; }},
        {"signal_value", [](auto& f) { f.signal_value = 2; }},
        {"flags", [](auto& f) { f.flags = 0x80; }},
        {"outputs", [](auto& f) { f.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL); }},
        {"camera.view[3]", [](auto& f) { f.camera.view[3] = kNan; }},
        {"camera.projection[0]", [](auto& f) { f.camera.projection[0] = kInfinity; }},
        {"camera.near_plane", [](auto& f) { f.camera.near_plane = kNan; }},
        {"camera planes", [](auto& f) { f.camera.near_plane = 0.0F; }},
        {"camera planes", [](auto& f) { f.camera.far_plane = f.camera.near_plane; }},
        {"sky.to_sun[1]", [](auto& f) { f.sky.to_sun[1] = kNan; }},
        {"sky.zenith[0]", [](auto& f) { f.sky.zenith[0] = -kInfinity; }},
        {"index", [](auto& f) { f.fluid.index_of_refraction = kNan; }},
    };
    for (const BadFrame& test : cases) {
        SluiceFrame frame = frameOf(1, 2, SLUICE_VIEW_FLUID);
        test.damage(frame);
        EXPECT_EQ(renderer.submit(frame), SLUICE_ERROR_INVALID_ARGUMENT) << test.named;
        EXPECT_THAT(renderer.error().message, HasSubstr(test.named));
    }
    EXPECT_EQ(api().submit_frame(renderer.get(), nullptr, nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    ASSERT_EQ(api().timeline_signal(renderer.get(), 1), SLUICE_OK);
    ASSERT_EQ(renderer.submit(frameOf(1, 2)), SLUICE_OK) << renderer.error().message;
    EXPECT_EQ(renderer.submit(frameOf(1, 2)), SLUICE_ERROR_INVALID_ARGUMENT) << "the same frame twice";
    EXPECT_EQ(api().timeline_wait(renderer.get(), 1, 20'000'000'000), SLUICE_OK);
}

TEST_F(RendererArguments, AFailedFrameMayBeFollowedByTheNext) {
    SluiceFrame failing = frameOf(1, 2);
    failing.camera.view[0] = kNan;
    ASSERT_EQ(renderer.submit(failing), SLUICE_ERROR_INVALID_ARGUMENT);
    ASSERT_EQ(api().timeline_signal(renderer.get(), 3), SLUICE_OK);
    ASSERT_EQ(renderer.submit(frameOf(2, 2)), SLUICE_OK) << renderer.error().message;
    EXPECT_EQ(api().timeline_wait(renderer.get(), 1, 20'000'000'000), SLUICE_OK)
        << "a later signal satisfies a wait for the failed frame";
}

TEST_F(RendererArguments, BadParticlesAreNamed) {
    ParticleCloud cloud(4);
    auto error = sized<SluiceError>();
    const auto set = [&](const SluiceParticles* particles) {
        error = sized<SluiceError>();
        return api().set_particles(renderer.get(), particles, &error);
    };
    EXPECT_EQ(set(nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceParticles bad = cloud.particles;
    bad.struct_size = 4;
    EXPECT_EQ(set(&bad), SLUICE_ERROR_INVALID_ARGUMENT);
    bad = cloud.particles;
    bad.position = nullptr;
    EXPECT_EQ(set(&bad), SLUICE_ERROR_INVALID_ARGUMENT);
    for (const float radius : {0.0F, -1.0F, kNan, kInfinity}) {
        bad = cloud.particles;
        bad.radius = radius;
        EXPECT_EQ(set(&bad), SLUICE_ERROR_INVALID_ARGUMENT) << radius;
        EXPECT_THAT(error.message, HasSubstr("radius"));
    }
    cloud.position[7] = kNan;
    EXPECT_EQ(set(&cloud.particles), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error.message, HasSubstr("position[7]"));
    SluiceParticles none{};
    none.struct_size = sizeof(none);
    EXPECT_EQ(set(&none), SLUICE_OK) << "no particles are no error";
}

TEST_F(RendererArguments, BadEnvironmentsAreNamed) {
    auto error = sized<SluiceError>();
    const float pixels[12] = {};
    SluiceEnvironment environment{};
    environment.struct_size = sizeof(environment);
    environment.width = 2;
    environment.height = 2;
    EXPECT_EQ(api().set_environment(renderer.get(), &environment, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    environment.pixels = pixels;
    environment.width = 0;
    EXPECT_EQ(api().set_environment(renderer.get(), &environment, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    environment.width = 2;
    environment.struct_size = 8;
    EXPECT_EQ(api().set_environment(renderer.get(), &environment, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().set_environment(renderer.get(), nullptr, &error), SLUICE_OK) << error.message;
}

TEST_F(RendererArguments, OtherCallsCheckTheirs) {
    auto error = sized<SluiceError>();
    std::uint64_t value = 0;
    std::int32_t fd = 7;
    auto stats = sized<SluiceFrameStats>();
    EXPECT_EQ(api().resize(renderer.get(), 0, 10, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().resize(renderer.get(), 10, 20000, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().info(renderer.get(), nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().poll(renderer.get(), 1, &stats), SLUICE_ERROR_INVALID_ARGUMENT) << "never submitted";
    EXPECT_EQ(api().poll(renderer.get(), 0, &stats), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().poll(renderer.get(), 1, nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().timeline_value(renderer.get(), 2, &value), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().timeline_value(renderer.get(), 0, nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().timeline_export(renderer.get(), 0, 1, &fd, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(fd, -1);
    EXPECT_EQ(api().timeline_export(renderer.get(), 5, 1, &fd, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().probe_format(host.services(), nullptr, SLUICE_FORMAT_R32F, 8, 8, &error),
              SLUICE_ERROR_INVALID_ARGUMENT);
    const SluiceCreateInfo info = host.createInfo();
    EXPECT_EQ(api().probe_format(host.services(), &info, SLUICE_FORMAT_NONE, 8, 8, &error),
              SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().probe_format(host.services(), &info, SLUICE_FORMAT_R32F, 0, 8, &error),
              SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().explain(nullptr, nullptr, nullptr, &error), SLUICE_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace sluice::vk::test
