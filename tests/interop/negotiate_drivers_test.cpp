// SPDX-License-Identifier: MIT
// What negotiation settles on for driver pairs that we do not own, from what is recorded or assumed of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "driver_fixtures.hpp"
#include "sluice/format.hpp"
#include "sluice/negotiate.hpp"

namespace {

using sluice::Agreement;
using sluice::NegotiationRequest;
using sluice::Reason;
using sluice::test::DriverPair;
using ::testing::HasSubstr;

constexpr std::uint32_t kEveryOutput =
    SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_COLOUR) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_DEPTH) |
    SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);

NegotiationRequest everything() {
    NegotiationRequest request;
    request.outputs = kEveryOutput;
    return request;
}

sluice::Result<Agreement> agree(const DriverPair& pair, const NegotiationRequest& request) {
    return sluice::negotiate(pair.gl, pair.vk, request);
}

Reason reasonFor(const std::vector<Reason>& reasons, std::string_view subject) {
    const auto found = std::ranges::find(reasons, subject, &Reason::subject);
    EXPECT_NE(found, reasons.end()) << subject << " was not considered";
    return found == reasons.end() ? Reason{} : *found;
}

void expectBestFormats(const Agreement& agreement) {
    EXPECT_EQ(agreement.formats[SLUICE_IMAGE_HOST_COLOUR], SLUICE_FORMAT_RGBA8);
    EXPECT_EQ(agreement.formats[SLUICE_IMAGE_HOST_DEPTH], SLUICE_FORMAT_D32F);
    EXPECT_EQ(agreement.formats[SLUICE_IMAGE_FLUID_COLOUR], SLUICE_FORMAT_RGBA16F);
    EXPECT_EQ(agreement.formats[SLUICE_IMAGE_FLUID_DEPTH], SLUICE_FORMAT_R32F);
    EXPECT_EQ(agreement.formats[SLUICE_IMAGE_FLUID_NORMAL], SLUICE_FORMAT_RGBA16F);
    EXPECT_EQ(agreement.formats[SLUICE_IMAGE_FLUID_THICKNESS], SLUICE_FORMAT_R16F);
    EXPECT_EQ(agreement.formats[SLUICE_IMAGE_CANARY], SLUICE_FORMAT_NONE);
    EXPECT_EQ(agreement.host_depth_encoding, SLUICE_DEPTH_WINDOW);
}

TEST(NegotiateDrivers, SoftwareMesaBridgesBecauseItSharesNoSemaphore) {
    const auto result = agree(sluice::test::recordedMesa22Software(), everything());
    ASSERT_TRUE(result.ok()) << result.error().message();
    EXPECT_EQ(result.value().timeline, SLUICE_TIMELINE_BRIDGED);
    expectBestFormats(result.value());
    const auto& reasons = result.value().reasons;
    const Reason native = reasonFor(reasons, "timeline native");
    EXPECT_FALSE(native.accepted);
    EXPECT_THAT(native.why, HasSubstr("GL_EXT_semaphore is missing"));
    EXPECT_THAT(native.why, HasSubstr("GL_NV_timeline_semaphore is missing"));
    EXPECT_THAT(native.why, HasSubstr("Vulkan cannot export a timeline semaphore"));
    EXPECT_THAT(reasonFor(reasons, "timeline binary").why, HasSubstr("GL_EXT_semaphore_fd is missing"));
    EXPECT_TRUE(reasonFor(reasons, "timeline bridged").accepted);
    EXPECT_FALSE(reasonFor(reasons, "timeline finish").accepted);
    EXPECT_TRUE(reasonFor(reasons, "HOST_DEPTH D32F").accepted);
    EXPECT_THAT(reasonFor(reasons, "HOST_DEPTH R32F").why, HasSubstr("D32F comes first"));
    EXPECT_TRUE(reasonFor(reasons, "device").accepted);
}

TEST(NegotiateDrivers, NewNvidiaSharesATimeline) {
    const auto result = agree(sluice::test::assumedNvidiaWithTimeline(), everything());
    ASSERT_TRUE(result.ok()) << result.error().message();
    EXPECT_EQ(result.value().timeline, SLUICE_TIMELINE_NATIVE);
    expectBestFormats(result.value());
    EXPECT_THAT(reasonFor(result.value().reasons, "timeline binary").why, HasSubstr("native comes first"));
}

TEST(NegotiateDrivers, OlderNvidiaSharesBinarySemaphores) {
    const auto result = agree(sluice::test::assumedNvidiaWithoutTimeline(), everything());
    ASSERT_TRUE(result.ok()) << result.error().message();
    EXPECT_EQ(result.value().timeline, SLUICE_TIMELINE_BINARY);
    EXPECT_EQ(reasonFor(result.value().reasons, "timeline native").why, "GL_NV_timeline_semaphore is missing");
}

TEST(NegotiateDrivers, RadeonSharesBinarySemaphores) {
    const auto result = agree(sluice::test::assumedRadeonMesa24(), everything());
    ASSERT_TRUE(result.ok()) << result.error().message();
    EXPECT_EQ(result.value().timeline, SLUICE_TIMELINE_BINARY);
    expectBestFormats(result.value());
}

TEST(NegotiateDrivers, HybridLaptopIsRefusedWithBothUuidsAndARemedy) {
    const DriverPair pair = sluice::test::assumedHybridLaptop();
    std::vector<Reason> reasons;
    const auto result = sluice::negotiate(pair.gl, pair.vk, everything(), &reasons);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, SLUICE_ERROR_DEVICE_MISMATCH);
    EXPECT_THAT(result.error().detail, HasSubstr("5e007c91-440a-3bd2-8800-176f9ce105b3"));
    EXPECT_THAT(result.error().detail, HasSubstr("00000000-0300-0000-0000-000000000000"));
    EXPECT_THAT(result.error().remedy, HasSubstr("DRI_PRIME"));
    EXPECT_FALSE(reasonFor(reasons, "device").accepted);
}

TEST(NegotiateDrivers, AFailedCanaryStrikesItsFormatAndTheNextIsTaken) {
    NegotiationRequest request = everything();
    request.failed_formats = sluice::formatBit(SLUICE_FORMAT_D32F) | sluice::formatBit(SLUICE_FORMAT_RGBA16F);
    const auto result = agree(sluice::test::recordedMesa22Software(), request);
    ASSERT_TRUE(result.ok()) << result.error().message();
    EXPECT_EQ(result.value().formats[SLUICE_IMAGE_HOST_DEPTH], SLUICE_FORMAT_R32F);
    EXPECT_EQ(result.value().host_depth_encoding, SLUICE_DEPTH_LINEAR);
    EXPECT_EQ(result.value().formats[SLUICE_IMAGE_FLUID_COLOUR], SLUICE_FORMAT_RGBA8);
    EXPECT_EQ(result.value().formats[SLUICE_IMAGE_FLUID_NORMAL], SLUICE_FORMAT_RGBA32F);
    EXPECT_THAT(reasonFor(result.value().reasons, "HOST_DEPTH D32F").why, HasSubstr("canary"));
}

TEST(NegotiateDrivers, WithoutFramebufferObjectsThereIsNoLinearDepth) {
    DriverPair pair = sluice::test::recordedMesa22Software();
    pair.gl.has_framebuffer_object = 0;
    NegotiationRequest request;
    request.host_depth = SLUICE_FORMAT_R32F;
    const auto result = agree(pair, request);
    ASSERT_FALSE(result.ok());
    EXPECT_THAT(result.error().detail, HasSubstr("framebuffer objects"));
    EXPECT_THAT(result.error().remedy, HasSubstr("do not force"));
    EXPECT_TRUE(agree(pair, NegotiationRequest{}).ok()) << "D32F needs no framebuffer";
}

TEST(NegotiateDrivers, ForcedTimelineThatTheDriversLackIsRefusedWithWhatWouldWork) {
    NegotiationRequest request = everything();
    request.timeline = SLUICE_TIMELINE_NATIVE;
    const auto result = agree(sluice::test::recordedMesa22Software(), request);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, SLUICE_ERROR_UNSUPPORTED);
    EXPECT_EQ(result.error().thing, "timeline native");
    EXPECT_THAT(result.error().remedy, HasSubstr("takes bridged here"));
}

TEST(NegotiateDrivers, ForcedChoicesAreHonouredWherePossible) {
    for (const auto kind :
         {SLUICE_TIMELINE_BINARY, SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH, SLUICE_TIMELINE_UNSYNCHRONISED}) {
        NegotiationRequest request = everything();
        request.timeline = kind;
        request.host_depth = SLUICE_FORMAT_R32F;
        const auto result = agree(sluice::test::assumedNvidiaWithTimeline(), request);
        ASSERT_TRUE(result.ok()) << result.error().message();
        EXPECT_EQ(result.value().timeline, kind);
        EXPECT_EQ(result.value().formats[SLUICE_IMAGE_HOST_DEPTH], SLUICE_FORMAT_R32F);
        EXPECT_THAT(reasonFor(result.value().reasons, "HOST_DEPTH D32F").why, HasSubstr("R32F was asked for"));
    }
}

TEST(NegotiateDrivers, ImpossibleRequestsAreNamed) {
    const DriverPair pair = sluice::test::recordedMesa22Software();
    NegotiationRequest depth;
    depth.host_depth = SLUICE_FORMAT_D24S8;
    ASSERT_FALSE(agree(pair, depth).ok());
    EXPECT_THAT(agree(pair, depth).error().message(), HasSubstr("D24S8 cannot carry host depth"));
    NegotiationRequest outputs;
    outputs.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_COLOUR);
    ASSERT_FALSE(agree(pair, outputs).ok());
    EXPECT_EQ(agree(pair, outputs).error().code, SLUICE_ERROR_INVALID_ARGUMENT);
}

TEST(NegotiateDrivers, AnyOfSeveralGlDevicesMayMatch) {
    // A GL context over linked GPUs reports all of them.
    DriverPair pair = sluice::test::assumedNvidiaWithTimeline();
    std::copy_n(pair.gl.device_uuids[0], SLUICE_UUID_SIZE, pair.gl.device_uuids[3]);
    pair.gl.device_uuids[0][15] ^= 1U;
    pair.gl.device_uuid_count = 4;
    EXPECT_TRUE(sluice::sameDevice(pair.gl, pair.vk));
    pair.gl.device_uuid_count = 3;
    EXPECT_FALSE(sluice::sameDevice(pair.gl, pair.vk)) << "beyond the count nothing is reported";
    pair.gl.device_uuid_count = 0xffffffffU;
    EXPECT_TRUE(sluice::sameDevice(pair.gl, pair.vk)) << "an absurd count is bounded by the array";
}

}  // namespace
