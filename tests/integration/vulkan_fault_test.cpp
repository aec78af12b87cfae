// SPDX-License-Identifier: MIT
// Vulkan itself fails under the real renderer: no memory for the Nth thing that it makes, a device that is lost with
// the Nth submission. Each case tries some spread over all; with SLUICE_EVERY_ALLOCATION set, every one.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "gl_test.hpp"
#include "plugins/vk_faults.hpp"
#include "recovery_rig.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr std::uint64_t kSome = 8;

class VulkanFault : public RecoveryTest {
  protected:
    void SetUp() override {
        // Read by the loader whenever an instance is created.
        setenv("VK_LAYER_PATH", SLUICE_LAYER_FOLDER, 1);
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_SLUICE_faults", 1);
        // Held, so that what is asked of it outlives an instance.
        layer_ = dlopen(SLUICE_LAYER_FOLDER "/libsluice_vk_faults.so", RTLD_NOW | RTLD_LOCAL);
        ASSERT_NE(layer_, nullptr) << dlerror();
        faults_ = static_cast<VkFaults*>(dlsym(layer_, kVkFaultSymbol));
        ASSERT_NE(faults_, nullptr);
        *faults_ = VkFaults{};
        ASSERT_NO_FATAL_FAILURE(RecoveryTest::SetUp());
    }
    void TearDown() override {
        RecoveryTest::TearDown();
        *faults_ = VkFaults{};
        dlclose(layer_);
        unsetenv("VK_INSTANCE_LAYERS");
        unsetenv("VK_LAYER_PATH");
    }
    [[nodiscard]] FluidHostConfig small() {
        FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
        wanted.width = 32;
        wanted.height = 16;
        wanted.recovery.settled_frames = 1;
        return wanted;
    }
    void beginSmall() {
        ASSERT_NO_FATAL_FAILURE(makeHost(small()));
        ASSERT_NO_FATAL_FAILURE(makeScreen(32, 16));
    }
    [[nodiscard]] static std::uint64_t stepOf(std::uint64_t all) {
        return std::getenv("SLUICE_EVERY_ALLOCATION") != nullptr ? 1 : std::max<std::uint64_t>(all / kSome, 1);
    }

    /// One life of a renderer with a frame of every pass; false when something of it failed, with a message.
    bool startAndDrawFluid() {
        FluidHostConfig wanted = small();
        wanted.recovery.attempts = 0;
        const auto host = FluidHost::create(*library_, wanted);
        if (!host) {
            EXPECT_FALSE(host.error().message().empty());
            return false;
        }
        const std::vector<float> positions{0.0F, 0.0F, -2.0F};
        auto particles = sized<SluiceParticles>();
        particles.count = 1;
        particles.radius = 0.5F;
        particles.position = positions.data();
        FrameInput input = echoInput();
        input.fluid.view = SLUICE_VIEW_FLUID;
        input.fluid.filter = SLUICE_FILTER_NARROW_RANGE;
        input.fluid.filter_iterations = 1;
        input.fluid.filter_range = 10.0F;
        input.fluid.filter_clamp = 1.0F;
        input.fluid.filter_sigma = 1.5F;
        input.fluid.filter_max_pixels = 8;
        input.fluid.thickness_blur = 1.5F;
        input.fluid.absorption[0] = 1.0F;
        input.fluid.refraction = 1;
        input.fluid.reflection = 1;
        Status status = host.value()->setParticles(particles);
        status = status ? host.value()->submit(*screen_, input) : status;
        status = status ? host.value()->composite(*screen_) : status;
        EXPECT_TRUE(status || !status.error().message().empty());
        return status.ok();
    }

    void* layer_ = nullptr;
    VkFaults* faults_ = nullptr;
};

TEST_F(VulkanFault, NoMemoryForOneThingOfAStartIsAnErrorAndLeavesNothing) {
    ASSERT_NO_FATAL_FAILURE(makeScreen(32, 16));
    EXPECT_TRUE(startAndDrawFluid());
    const std::uint64_t all = faults_->made;
    ASSERT_GT(all, 50U) << "the layer is not in use";
    RecordProperty("calls", static_cast<int>(all));
    const int descriptors = openDescriptors();
    std::uint64_t failed = 0;
    for (std::uint64_t nth = 1; nth <= all; nth += stepOf(all)) {
        SCOPED_TRACE(nth);
        *faults_ = VkFaults{};
        faults_->starve_at = nth;
        // Some are made up for: a format whose canary finds no memory makes way for the next.
        failed += startAndDrawFluid() ? 0U : 1U;
    }
    EXPECT_GT(failed, kSome / 2);
    EXPECT_TRUE(descriptorsReturnTo(descriptors)) << openDescriptors() << " instead of " << descriptors;
    *faults_ = VkFaults{};
    ASSERT_NO_FATAL_FAILURE(beginSmall());
    EXPECT_EQ(run(2), "ff");
    complaints_.clear();
}

TEST_F(VulkanFault, NoMemoryForOneThingOfAResizeOrAFrameIsMadeUpFor) {
    ASSERT_NO_FATAL_FAILURE(beginSmall());
    EXPECT_EQ(run(1), "f");
    *faults_ = VkFaults{};
    ASSERT_TRUE(host_->resize(33, 16));
    ASSERT_NO_FATAL_FAILURE(makeScreen(33, 16));
    EXPECT_EQ(run(1), "f");
    const std::uint64_t all = faults_->made;
    RecordProperty("calls", static_cast<int>(all));
    const int descriptors = openDescriptors();
    for (std::uint64_t nth = 1; nth <= all; nth += stepOf(all)) {
        SCOPED_TRACE(nth);
        *faults_ = VkFaults{};
        faults_->starve_at = nth;
        (void)host_->resize(33, 16);
        EXPECT_THAT(run(6), EndsWith("ff"));
    }
    EXPECT_TRUE(descriptorsReturnTo(descriptors)) << openDescriptors() << " instead of " << descriptors;
    complaints_.clear();
}

TEST_F(VulkanFault, ADeviceThatIsLostWithASubmissionCostsThatFrame) {
    for (const SluiceTimelineKind timeline : {SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH}) {
        *faults_ = VkFaults{};
        drawn_ = 0;
        FluidHostConfig wanted = small();
        wanted.timeline = timeline;
        ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
        ASSERT_NO_FATAL_FAILURE(makeScreen(32, 16));
        EXPECT_EQ(run(2), "ff");
        const int descriptors = openDescriptors();
        for (int round = 0; round < 3; ++round) {
            SCOPED_TRACE(round);
            faults_->lose_at = faults_->submitted + 2;  // the frame after the next
            EXPECT_EQ(run(6), "f-ffff");
        }
        EXPECT_EQ(host_->renderers(), 4U);
        EXPECT_TRUE(descriptorsReturnTo(descriptors)) << openDescriptors() << " instead of " << descriptors;
        EXPECT_THAT(failures_, ::testing::Each(HasSubstr("VK_ERROR_DEVICE_LOST")));
        host_.reset();
    }
    complaints_.clear();
}

}  // namespace
}  // namespace sluice::host::test
