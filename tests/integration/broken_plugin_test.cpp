// SPDX-License-Identifier: MIT
// A plugin whose functions fail, and one that says what is not so: no crash, no leak, one clear message, and fluid
// again as soon as the plugin is right again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "gl_test.hpp"
#include "recovery_rig.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class BrokenPlugin : public RecoveryTest {
  protected:
    /// Creates a host and expects it to fail without leaving anything behind.
    std::string refusal() {
        const FluidHostConfig wanted = recovering(SLUICE_TIMELINE_FINISH);
        const int before = openDescriptors();
        const auto host = FluidHost::create(*library_, wanted);
        EXPECT_FALSE(host);
        EXPECT_TRUE(descriptorsReturnTo(before)) << openDescriptors() << " instead of " << before;
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        return host ? "created" : host.error().message();
    }
    void warmUp() {
        ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_FINISH)));
        EXPECT_EQ(run(1), "f");
        host_.reset();
        drawn_ = 0;
    }
};

TEST_F(BrokenPlugin, EachFunctionThatFailsCostsFluidAndNothingElse) {
    ASSERT_NO_FATAL_FAILURE(warmUp());
    std::vector<float> positions(3, 0.0F);
    auto particles = sized<SluiceParticles>();
    particles.count = 1;
    particles.radius = 0.5F;
    particles.position = positions.data();
    for (const Entry entry :
         {Entry::Resize, Entry::SetParticles, Entry::SetEnvironment, Entry::SubmitFrame, Entry::Poll,
          Entry::TimelineSignal, Entry::TimelineWait, Entry::TimelineValue, Entry::TimelineExport}) {
        SCOPED_TRACE(static_cast<int>(entry));
        resetShim();
        drawn_ = 0;
        ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_FINISH)));
        EXPECT_EQ(run(1), "f");
        const int descriptors = openDescriptors();
        control_->broken = entry;
        const Status set = host_->setParticles(particles);
        EXPECT_EQ(set.ok(), entry != Entry::SetParticles);
        // Without a renderer these two are kept for the next, or try to make it.
        const Status sky = host_->setEnvironment(nullptr);
        EXPECT_EQ(sky.ok(), entry != Entry::SetEnvironment);
        const Status resized = host_->resize(kEchoWidth, kEchoHeight);
        EXPECT_EQ(resized.ok(), entry != Entry::Resize && set.ok());
        run(2);
        const auto stats = host_->stats(host_->frame());
        EXPECT_TRUE(stats.ok() || !stats.error().message().empty());
        control_->broken = Entry::None;
        EXPECT_THAT(run(8), ::testing::EndsWith("ff"));
        EXPECT_TRUE(descriptorsReturnTo(descriptors)) << openDescriptors() << " instead of " << descriptors;
    }
    complaints_.clear();
}

TEST_F(BrokenPlugin, WhatFailsAtTheStartIsSaidOnOneLine) {
    ASSERT_NO_FATAL_FAILURE(warmUp());
    control_->broken = Entry::Create;
    const std::string endless = refusal();
    EXPECT_THAT(endless, HasSubstr("renderer create: xxxx"));
    EXPECT_LE(endless.size(), 600U) << "a message without an end ends with its array";
    control_->broken = Entry::Info;
    EXPECT_THAT(refusal(), HasSubstr("renderer info"));
    complaints_.clear();
}

TEST_F(BrokenPlugin, ImagesThatAreNotWhatTheySayAreRefusedByName) {
    ASSERT_NO_FATAL_FAILURE(warmUp());
    for (const ImageLie lie : {ImageLie::Role, ImageLie::OtherRole, ImageLie::Set, ImageLie::Format, ImageLie::NoWidth,
                               ImageLie::TwiceAsWide, ImageLie::NoMemory, ImageLie::Tiny, ImageLie::NotShared}) {
        SCOPED_TRACE(static_cast<int>(lie));
        resetShim();
        control_->image_lie = lie;
        EXPECT_THAT(refusal(), AllOf(HasSubstr("renderer "), Not(HasSubstr("\n"))));
    }
    resetShim();
    EXPECT_NO_FATAL_FAILURE(warmUp());
    complaints_.clear();
}

TEST_F(BrokenPlugin, AnAccountThatCannotBeTrueIsRefused) {
    ASSERT_NO_FATAL_FAILURE(warmUp());
    for (const InfoLie lie : {InfoLie::Timeline, InfoLie::Sets, InfoLie::Size, InfoLie::Format, InfoLie::Encoding}) {
        SCOPED_TRACE(static_cast<int>(lie));
        control_->info_lie = lie;
        EXPECT_THAT(refusal(), AllOf(HasSubstr("renderer info: "), HasSubstr("(the plugin is broken)")));
    }
    control_->info_lie = InfoLie::EndlessNames;
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_FINISH)));
    EXPECT_LT(strnlen(host_->info().capabilities.device_name, 128), 128U);
    control_->stats_lie = StatsLie::EndlessNames;
    EXPECT_EQ(run(1), "f");
    const auto named = host_->stats(1);
    ASSERT_TRUE(named);
    EXPECT_EQ(strnlen(named.value().passes[0].name, 32), 31U);
    control_->stats_lie = StatsLie::PassCount;
    const auto counted = host_->stats(1);
    ASSERT_FALSE(counted);
    EXPECT_THAT(counted.error().message(), HasSubstr("expected 32 passes at most, found 1000000000"));
    complaints_.clear();
}

}  // namespace
}  // namespace sluice::host::test
