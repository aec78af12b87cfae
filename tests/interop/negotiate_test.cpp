// SPDX-License-Identifier: MIT
// Negotiation as properties over random capabilities, against rules restated here from docs/architecture.md.
#include "sluice/negotiate.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "driver_fixtures.hpp"
#include "sluice/format.hpp"

namespace {

using sluice::Agreement;
using sluice::NegotiationRequest;
using sluice::Reason;

struct Case {
    SluiceHostCapabilities gl{};
    SluiceRendererCapabilities vk{};
    NegotiationRequest request;
};

/// Mostly yes, so that most cases get past the first obstacle.
std::uint32_t flag() {
    return *rc::gen::weightedElement<std::uint32_t>({{24, 1U}, {1, 0U}});
}

std::uint32_t formats() {
    const auto mask = *rc::gen::arbitrary<std::uint32_t>();
    return *rc::gen::weightedElement<std::uint32_t>({{10, sluice::test::kAllFormats}, {1, mask}, {3, mask | 0x186U}});
}

Case arbitraryCase() {
    Case c;
    c.gl.device_uuid_count = *rc::gen::weightedElement<std::uint32_t>({{1, 0U}, {16, 1U}, {4, 2U}, {2, 4U}});
    for (auto& uuid : c.gl.device_uuids) {
        std::ranges::generate(uuid, [] { return *rc::gen::inRange<std::uint8_t>(0, 2); });
    }
    std::ranges::copy(c.gl.device_uuids[*rc::gen::weightedElement<std::size_t>({{19, 0U}, {1, 3U}})], c.vk.device_uuid);
    c.vk.driver_uuid[15] = static_cast<std::uint8_t>(1U - flag());
    for (auto* member : {&c.gl.has_memory_object, &c.gl.has_memory_object_fd, &c.gl.has_sync,
                         &c.gl.has_framebuffer_object, &c.vk.has_external_memory_fd, &c.vk.has_timeline_semaphore}) {
        *member = flag();
    }
    for (auto* member : {&c.gl.has_semaphore, &c.gl.has_semaphore_fd, &c.gl.has_timeline_semaphore,
                         &c.vk.exports_timeline_fd, &c.vk.exports_binary_fd}) {
        *member = *rc::gen::inRange<std::uint32_t>(0, 2);
    }
    for (auto* member :
         {&c.gl.texture_formats, &c.gl.attachment_formats, &c.vk.exportable_formats, &c.vk.storage_formats}) {
        *member = formats();
    }
    c.request.timeline = static_cast<SluiceTimelineKind>(
        *rc::gen::weightedElement<int>({{12, 0}, {1, 1}, {1, 2}, {1, 3}, {1, 4}, {1, 5}}));
    c.request.outputs = *rc::gen::inRange<std::uint32_t>(0, 16)
                        << static_cast<std::uint32_t>(SLUICE_IMAGE_FLUID_COLOUR);
    c.request.host_depth = *rc::gen::weightedElement<SluiceFormat>(
        {{16, SLUICE_FORMAT_NONE}, {2, SLUICE_FORMAT_D32F}, {2, SLUICE_FORMAT_R32F}, {1, SLUICE_FORMAT_R8}});
    c.request.failed_formats =
        *rc::gen::weightedElement<bool>({{1, true}, {7, false}}) ? *rc::gen::arbitrary<std::uint32_t>() : 0;
    return c;
}

bool timelinePossible(const Case& c, SluiceTimelineKind kind) {
    switch (kind) {
        case SLUICE_TIMELINE_NATIVE:
            return c.gl.has_semaphore && c.gl.has_semaphore_fd && c.gl.has_timeline_semaphore &&
                   c.vk.has_timeline_semaphore && c.vk.exports_timeline_fd;
        case SLUICE_TIMELINE_BINARY:
            return c.gl.has_semaphore && c.gl.has_semaphore_fd && c.vk.exports_binary_fd;
        case SLUICE_TIMELINE_BRIDGED:
            return c.gl.has_sync && c.vk.has_timeline_semaphore;
        default:
            return true;
    }
}

SluiceTimelineKind expectedTimeline(const Case& c) {
    if (c.request.timeline != SLUICE_TIMELINE_AUTO) {
        return timelinePossible(c, c.request.timeline) ? c.request.timeline : SLUICE_TIMELINE_AUTO;
    }
    for (const auto kind : {SLUICE_TIMELINE_NATIVE, SLUICE_TIMELINE_BINARY, SLUICE_TIMELINE_BRIDGED}) {
        if (timelinePossible(c, kind)) {
            return kind;
        }
    }
    return SLUICE_TIMELINE_FINISH;
}

bool isFluid(SluiceImageRole role) {
    return role >= SLUICE_IMAGE_FLUID_COLOUR && role <= SLUICE_IMAGE_FLUID_THICKNESS;
}

bool isWanted(const Case& c, SluiceImageRole role) {
    return role <= SLUICE_IMAGE_FLUID_DEPTH ||
           (role != SLUICE_IMAGE_CANARY && (c.request.outputs & SLUICE_ROLE_BIT(role)) != 0);
}

bool formatPossible(const Case& c, SluiceImageRole role, SluiceFormat format) {
    const std::uint32_t bit = sluice::formatBit(format);
    const bool both = (c.gl.texture_formats & c.vk.exportable_formats & ~c.request.failed_formats & bit) != 0;
    const bool written = !isFluid(role) || (c.vk.storage_formats & bit) != 0;
    const bool drawn = role != SLUICE_IMAGE_HOST_DEPTH || format != SLUICE_FORMAT_R32F ||
                       (c.gl.has_framebuffer_object != 0 && (c.gl.attachment_formats & bit) != 0);
    const bool allowed =
        role != SLUICE_IMAGE_HOST_DEPTH || c.request.host_depth == SLUICE_FORMAT_NONE || c.request.host_depth == format;
    return both && written && drawn && allowed;
}

SluiceFormat expectedFormat(const Case& c, SluiceImageRole role) {
    for (const SluiceFormat format : sluice::formatCandidates(role)) {
        if (formatPossible(c, role, format)) {
            return format;
        }
    }
    return SLUICE_FORMAT_NONE;
}

bool expectedToAgree(const Case& c) {
    bool possible = sluice::sameDevice(c.gl, c.vk) && c.gl.has_memory_object && c.gl.has_memory_object_fd &&
                    c.vk.has_external_memory_fd && c.request.host_depth != SLUICE_FORMAT_R8 &&
                    expectedTimeline(c) != SLUICE_TIMELINE_AUTO;
    for (int role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
        const auto r = static_cast<SluiceImageRole>(role);
        possible = possible && (!isWanted(c, r) || expectedFormat(c, r) != SLUICE_FORMAT_NONE);
    }
    return possible;
}

bool sameReasons(const std::vector<Reason>& a, const std::vector<Reason>& b) {
    return std::ranges::equal(a, b, [](const Reason& x, const Reason& y) {
        return x.subject == y.subject && x.accepted == y.accepted && x.why == y.why;
    });
}

RC_GTEST_PROP(Negotiate, AgreesExactlyWhenTheRulesAllowIt, ()) {
    const Case c = arbitraryCase();
    const auto result = sluice::negotiate(c.gl, c.vk, c.request);
    const bool expected = expectedToAgree(c);
    RC_CLASSIFY(expected);
    RC_ASSERT(result.ok() == expected);
}

RC_GTEST_PROP(Negotiate, TakesTheBestPossibleFormatOfEveryWantedRoleAndNoOther, ()) {
    const Case c = arbitraryCase();
    const auto result = sluice::negotiate(c.gl, c.vk, c.request);
    RC_PRE(result.ok());
    const Agreement& agreement = result.value();
    for (int role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        const auto r = static_cast<SluiceImageRole>(role);
        const SluiceFormat format = agreement.formats[static_cast<std::size_t>(role)];
        RC_ASSERT(format == (isWanted(c, r) ? expectedFormat(c, r) : SLUICE_FORMAT_NONE));
        if (format != SLUICE_FORMAT_NONE) {
            const std::uint32_t bit = sluice::formatBit(format);
            RC_ASSERT((c.gl.texture_formats & bit) != 0U);
            RC_ASSERT((c.vk.exportable_formats & bit) != 0U);
            RC_ASSERT((c.request.failed_formats & bit) == 0U);
        }
    }
    RC_ASSERT((agreement.host_depth_encoding == SLUICE_DEPTH_WINDOW) ==
              (agreement.formats[SLUICE_IMAGE_HOST_DEPTH] == SLUICE_FORMAT_D32F));
}

RC_GTEST_PROP(Negotiate, TakesTheBestTimelineThatBothSidesHave, ()) {
    const Case c = arbitraryCase();
    const auto result = sluice::negotiate(c.gl, c.vk, c.request);
    RC_PRE(result.ok());
    const SluiceTimelineKind kind = result.value().timeline;
    RC_ASSERT(timelinePossible(c, kind));
    RC_ASSERT(kind == expectedTimeline(c));
    RC_ASSERT(kind != SLUICE_TIMELINE_UNSYNCHRONISED || c.request.timeline == SLUICE_TIMELINE_UNSYNCHRONISED);
}

RC_GTEST_PROP(Negotiate, TellsAReasonForEveryCandidate, ()) {
    const Case c = arbitraryCase();
    std::vector<Reason> reasons;
    const auto result = sluice::negotiate(c.gl, c.vk, c.request, &reasons);
    if (result.ok()) {
        RC_ASSERT(reasons.empty());
        reasons = result.value().reasons;
        const auto has = [&](const std::string& subject, bool accepted) {
            return std::ranges::count_if(
                       reasons, [&](const Reason& r) { return r.subject == subject && r.accepted == accepted; }) == 1;
        };
        for (int role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
            const auto r = static_cast<SluiceImageRole>(role);
            for (const SluiceFormat format : sluice::formatCandidates(r)) {
                const std::string subject = std::string(sluice::toString(r)) + " " +
                                            std::string(sluice::findFormat(static_cast<std::uint32_t>(format))->name);
                RC_ASSERT(!isWanted(c, r) ||
                          has(subject, format == result.value().formats[static_cast<std::size_t>(role)]));
            }
        }
        for (int kind = SLUICE_TIMELINE_NATIVE; kind < SLUICE_TIMELINE_KIND_COUNT; ++kind) {
            const auto k = static_cast<SluiceTimelineKind>(kind);
            RC_ASSERT(has("timeline " + std::string(sluice::toString(k)), k == result.value().timeline));
        }
    } else {
        RC_ASSERT(result.error().code < 0);
        RC_ASSERT(!result.error().thing.empty());
        RC_ASSERT(!result.error().detail.empty());
        RC_ASSERT(!result.error().remedy.empty());
        RC_ASSERT(std::ranges::any_of(reasons, [](const Reason& r) { return !r.accepted; }));
    }
    RC_ASSERT(!reasons.empty());
    for (const Reason& reason : reasons) {
        RC_ASSERT(!reason.subject.empty());
        RC_ASSERT(!reason.why.empty());
    }
}

RC_GTEST_PROP(Negotiate, IsDeterministic, ()) {
    const Case c = arbitraryCase();
    std::vector<Reason> first_reasons;
    std::vector<Reason> second_reasons;
    const auto first = sluice::negotiate(c.gl, c.vk, c.request, &first_reasons);
    const auto second = sluice::negotiate(c.gl, c.vk, c.request, &second_reasons);
    RC_ASSERT(first.ok() == second.ok());
    RC_ASSERT(sameReasons(first_reasons, second_reasons));
    if (first.ok()) {
        RC_ASSERT(first.value().timeline == second.value().timeline);
        RC_ASSERT(first.value().formats == second.value().formats);
        RC_ASSERT(sameReasons(first.value().reasons, second.value().reasons));
    } else {
        RC_ASSERT(first.error().message() == second.error().message());
    }
}

// The canary protocol strikes formats one by one; that must end in an agreement without them or in a refusal.
RC_GTEST_PROP(Negotiate, StrikingEveryChosenFormatEndsAfterFewRounds, ()) {
    Case c = arbitraryCase();
    for (int round = 0; round <= SLUICE_FORMAT_COUNT; ++round) {
        const auto result = sluice::negotiate(c.gl, c.vk, c.request);
        if (!result.ok()) {
            return;
        }
        for (const SluiceFormat format : result.value().formats) {
            c.request.failed_formats |= format == SLUICE_FORMAT_NONE ? 0U : sluice::formatBit(format);
        }
    }
    RC_FAIL("still agreeing after every format was struck");
}

TEST(Negotiate, AnySingleFlippedUuidBitIsRefused) {
    const auto pair = sluice::test::assumedNvidiaWithTimeline();
    ASSERT_TRUE(sluice::negotiate(pair.gl, pair.vk, {}).ok());
    for (std::uint32_t bit = 0; bit < SLUICE_UUID_SIZE * 8; ++bit) {
        const auto flip = [bit](std::uint8_t* uuid) { uuid[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8)); };
        for (int which = 0; which < 4; ++which) {
            auto broken = pair;
            flip(which == 0   ? broken.gl.device_uuids[0]
                 : which == 1 ? broken.gl.driver_uuid
                 : which == 2 ? broken.vk.device_uuid
                              : broken.vk.driver_uuid);
            EXPECT_FALSE(sluice::sameDevice(broken.gl, broken.vk));
            const auto result = sluice::negotiate(broken.gl, broken.vk, {});
            ASSERT_FALSE(result.ok()) << "bit " << bit << " of uuid " << which;
            EXPECT_EQ(result.error().code, SLUICE_ERROR_DEVICE_MISMATCH);
        }
    }
}

TEST(Negotiate, RefusesARequestOutsideTheEnumeration) {
    const auto pair = sluice::test::recordedMesa22Software();
    NegotiationRequest request;
    request.timeline = SLUICE_TIMELINE_KIND_COUNT;
    const auto result = sluice::negotiate(pair.gl, pair.vk, request);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
}

TEST(FormatCandidates, AreTheTableOfTheArchitecture) {
    using Formats = std::vector<SluiceFormat>;
    EXPECT_EQ(sluice::formatCandidates(SLUICE_IMAGE_HOST_COLOUR), Formats{SLUICE_FORMAT_RGBA8});
    EXPECT_EQ(sluice::formatCandidates(SLUICE_IMAGE_HOST_DEPTH), (Formats{SLUICE_FORMAT_D32F, SLUICE_FORMAT_R32F}));
    EXPECT_EQ(sluice::formatCandidates(SLUICE_IMAGE_FLUID_COLOUR),
              (Formats{SLUICE_FORMAT_RGBA16F, SLUICE_FORMAT_RGBA8}));
    EXPECT_EQ(sluice::formatCandidates(SLUICE_IMAGE_FLUID_DEPTH), Formats{SLUICE_FORMAT_R32F});
    EXPECT_EQ(sluice::formatCandidates(SLUICE_IMAGE_FLUID_NORMAL),
              (Formats{SLUICE_FORMAT_RGBA16F, SLUICE_FORMAT_RGBA32F}));
    EXPECT_EQ(sluice::formatCandidates(SLUICE_IMAGE_FLUID_THICKNESS),
              (Formats{SLUICE_FORMAT_R16F, SLUICE_FORMAT_R32F}));
    EXPECT_TRUE(sluice::formatCandidates(SLUICE_IMAGE_CANARY).empty());
}

}  // namespace
