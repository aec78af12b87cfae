// SPDX-License-Identifier: MIT
// Sides of different minor versions: structs that are shorter or longer than this side's, and those that are too short.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "core_fake_host.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kLong = 60'000'000'000;
constexpr std::byte kUntouched{0xA5};

/// A T of another minor version, in memory of exactly its size, so that AddressSanitizer sees a byte too many.
template <typename T>
class Foreign {
  public:
    Foreign(const T& from, std::size_t size) : bytes_(size / sizeof(std::uint64_t) + 1), size_(size) {
        std::memset(bytes_.data(), static_cast<int>(kUntouched), bytes_.size() * sizeof(std::uint64_t));
        std::memcpy(bytes_.data(), &from, std::min(size, sizeof(T)));
        get()->struct_size = static_cast<std::uint32_t>(size);
    }
    T* get() { return reinterpret_cast<T*>(bytes_.data()); }
    [[nodiscard]] bool untouchedFrom(std::size_t begin) const {
        const auto* at = reinterpret_cast<const std::byte*>(bytes_.data());
        return std::all_of(at + begin, at + bytes_.size() * sizeof(std::uint64_t),
                           [](std::byte b) { return b == kUntouched; });
    }

  private:
    std::vector<std::uint64_t> bytes_;
    std::size_t size_;
};

template <typename T>
constexpr std::size_t longer() {
    return sizeof(T) + 24;
}

/// One whole life of a renderer with every struct of the size that `pick` chooses.
template <typename Pick>
void liveWith(Pick pick) {
    FakeHost host;
    Foreign<SluiceHostServices> services(*host.services(), pick(host.services()));
    SluiceCreateInfo plain = host.createInfo();
    Foreign<SluiceCreateInfo> info(plain, pick(&plain));
    const auto blank = sized<SluiceError>();
    Foreign<SluiceError> error(blank, pick(&blank));
    const auto said = [&] { return std::string(error.get()->message); };

    auto capabilities = sized<SluiceRendererCapabilities>();
    Foreign<SluiceRendererCapabilities> described(capabilities, pick(&capabilities));
    ASSERT_EQ(api().describe(services.get(), info.get(), described.get(), error.get()), SLUICE_OK) << said();
    EXPECT_NE(described.get()->device_name[0], '\0');
    EXPECT_LE(described.get()->struct_size, sizeof(SluiceRendererCapabilities));
    EXPECT_TRUE(described.untouchedFrom(std::min(pick(&capabilities), sizeof(SluiceRendererCapabilities))));

    SluiceRenderer* renderer = nullptr;
    ASSERT_EQ(api().create(services.get(), info.get(), &renderer, error.get()), SLUICE_OK) << said();
    auto found = sized<SluiceRendererInfo>();
    Foreign<SluiceRendererInfo> told(found, pick(&found));
    EXPECT_EQ(api().info(renderer, told.get()), SLUICE_OK);
    EXPECT_EQ(told.get()->width, plain.width);
    EXPECT_TRUE(told.untouchedFrom(std::min(pick(&found), sizeof(SluiceRendererInfo))));

    ParticleCloud cloud(20);
    Foreign<SluiceParticles> particles(cloud.particles, pick(&cloud.particles));
    EXPECT_EQ(api().set_particles(renderer, particles.get(), error.get()), SLUICE_OK) << said();
    const float pixels[12] = {};
    const SluiceEnvironment map{sizeof(SluiceEnvironment), 2, 2, pixels};
    Foreign<SluiceEnvironment> environment(map, pick(&map));
    EXPECT_EQ(api().set_environment(renderer, environment.get(), error.get()), SLUICE_OK) << said();

    const SluiceFrame sent = frameOf(1, plain.image_sets, SLUICE_VIEW_FLUID);
    Foreign<SluiceFrame> frame(sent, pick(&sent));
    EXPECT_EQ(api().submit_frame(renderer, frame.get(), error.get()), SLUICE_OK) << said();
    EXPECT_EQ(api().timeline_signal(renderer, 1), SLUICE_OK);
    EXPECT_EQ(api().timeline_wait(renderer, 1, kLong), SLUICE_OK);
    const auto none = sized<SluiceFrameStats>();
    Foreign<SluiceFrameStats> stats(none, pick(&none));
    EXPECT_EQ(api().poll(renderer, 1, stats.get()), SLUICE_OK);
    EXPECT_EQ(stats.get()->frame, 1U);
    EXPECT_GT(stats.get()->pass_count, 0U);
    EXPECT_TRUE(stats.untouchedFrom(std::min(pick(&none), sizeof(SluiceFrameStats))));

    EXPECT_EQ(api().resize(renderer, 0, 1, error.get()), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said(), HasSubstr("0x1"));
    api().destroy(renderer);
}

TEST(Abi, StructsOfVersionOneDotZeroWork) {
    liveWith([]<typename T>(const T*) { return kAbiMinimum<T>; });
}

TEST(Abi, StructsOfANewerMinorWork) {
    liveWith([]<typename T>(const T*) { return longer<T>(); });
}

class TooShort : public ::testing::TestWithParam<bool> {
  protected:
    void SetUp() override { ASSERT_EQ(renderer.result(), SLUICE_OK) << renderer.error().message; }
    /// 0, which earlier drafts of the ABI took for "as in this header", or one byte short of 1.0.
    template <typename T>
    T shortened(T value) const {
        value.struct_size = GetParam() ? 0 : static_cast<std::uint32_t>(kAbiMinimum<T> - 1);
        return value;
    }
    template <typename T>
    void expectRefused(SluiceResult result, const char* thing) const {
        EXPECT_EQ(result, SLUICE_ERROR_INVALID_ARGUMENT) << thing;
        EXPECT_THAT(error.message, HasSubstr(thing));
        EXPECT_THAT(error.message, HasSubstr("at least " + std::to_string(kAbiMinimum<T>) + " is needed"));
    }
    FakeHost host;
    SluiceCreateInfo info = host.createInfo();
    TestRenderer renderer{host, info};
    SluiceError error = sized<SluiceError>();
};

TEST_P(TooShort, InputsAreRefusedByName) {
    SluiceRenderer* none = nullptr;
    const SluiceHostServices services = shortened(*host.services());
    expectRefused<SluiceHostServices>(api().create(&services, &info, &none, &error), "host");
    const SluiceCreateInfo create = shortened(info);
    expectRefused<SluiceCreateInfo>(api().create(host.services(), &create, &none, &error), "info");
    SluiceCreateInfo nested = info;
    nested.host = shortened(nested.host);
    expectRefused<SluiceHostCapabilities>(api().create(host.services(), &nested, &none, &error), "info.host");
    EXPECT_EQ(none, nullptr);
    const ParticleCloud cloud(3);
    const SluiceParticles particles = shortened(cloud.particles);
    expectRefused<SluiceParticles>(api().set_particles(renderer.get(), &particles, &error), "particles");
    const float pixel[3] = {};
    const SluiceEnvironment map = shortened(SluiceEnvironment{0, 1, 1, pixel});
    expectRefused<SluiceEnvironment>(api().set_environment(renderer.get(), &map, &error), "environment");
    const SluiceFrame frame = shortened(frameOf(1, 2));
    expectRefused<SluiceFrame>(api().submit_frame(renderer.get(), &frame, &error), "frame");
    const SluiceSceneNeeds needs = shortened(SluiceSceneNeeds{});
    expectRefused<SluiceSceneNeeds>(api().explain(&needs, nullptr, nullptr, &error), "needs");
}

TEST_P(TooShort, OutputsAreRefusedAndLeftAlone) {
    SluiceRendererInfo found = shortened(SluiceRendererInfo{});
    EXPECT_EQ(api().info(renderer.get(), &found), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(found.width, 0U);
    SluiceFrameStats stats = shortened(SluiceFrameStats{});
    EXPECT_EQ(api().poll(renderer.get(), 1, &stats), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceRendererCapabilities capabilities = shortened(SluiceRendererCapabilities{});
    expectRefused<SluiceRendererCapabilities>(api().describe(host.services(), &info, &capabilities, &error),
                                              "capabilities");
    EXPECT_EQ(capabilities.device_name[0], '\0');
    SluiceError small = shortened(SluiceError{});
    EXPECT_EQ(api().resize(renderer.get(), 80, 60, &small), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(host.held().begin()->second.width, info.width) << "nothing was done";
    if (GetParam()) {
        EXPECT_EQ(small.message[0], '\0');
    } else {
        EXPECT_THAT(small.message, HasSubstr("error: struct_size is 519"));
    }
}

INSTANTIATE_TEST_SUITE_P(Abi, TooShort, ::testing::Bool());

}  // namespace
}  // namespace sluice::vk::test
