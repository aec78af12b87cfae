// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "isolate_samples.hpp"
#include "sluice/isolate/messages.hpp"

namespace sluice::isolate {
namespace {

using ::testing::HasSubstr;

TEST(IsolateMessages, EveryKindComesBackAsItWasSent) {
    std::vector<bool> seen(std::variant_size_v<Message>);
    for (const Message& message : test::sampleMessages()) {
        const std::uint32_t fds = test::descriptorsOf(message);
        const std::vector<std::byte> bytes = encode(message, 77, fds);
        const Result<Decoded> decoded = decode(bytes, fds);
        ASSERT_TRUE(decoded) << decoded.error().message();
        EXPECT_EQ(decoded.value().call, 77U);
        EXPECT_EQ(decoded.value().message.index(), message.index());
        EXPECT_TRUE(encode(decoded.value().message, 77, fds) == bytes) << nameOf(message);
        seen.at(message.index()) = true;
    }
    EXPECT_THAT(seen, ::testing::Each(true)) << "a kind has no sample";
}

TEST(IsolateMessages, ACutOrLongerMessageIsRefusedByName) {
    for (const Message& message : test::sampleMessages()) {
        const std::uint32_t fds = test::descriptorsOf(message);
        std::vector<std::byte> bytes = encode(message, 1, fds);
        for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 16) {
            EXPECT_FALSE(decode(std::span(bytes).first(length), fds)) << nameOf(message) << " cut at " << length;
        }
        bytes.resize(bytes.size() + 1);
        EXPECT_FALSE(decode(bytes, fds)) << nameOf(message);
        // A header that owns up to the surplus does not help.
        const auto length = static_cast<std::uint32_t>(bytes.size() - 24);
        std::memcpy(&bytes[8], &length, sizeof(length));
        const Result<Decoded> surplus = decode(bytes, fds);
        ASSERT_FALSE(surplus) << nameOf(message);
        EXPECT_THAT(surplus.error().message(), HasSubstr("message " + std::string(nameOf(message)) + ": at byte "));
        EXPECT_THAT(surplus.error().message(), HasSubstr("expected the end of the message, found 1 bytes more"));
    }
}

TEST(IsolateMessages, AnotherNumberOfDescriptorsIsRefused) {
    for (const Message& message : test::sampleMessages()) {
        EXPECT_FALSE(decode(encode(message, 1, 3), 3)) << nameOf(message);
        EXPECT_FALSE(decode(encode(message, 1, 1), 0)) << nameOf(message);
    }
}

TEST(IsolateMessages, DamagedBytesAreRefusedOrReadAndNothingElse) {
    std::mt19937 random(1);
    for (const Message& message : test::sampleMessages()) {
        const std::uint32_t fds = test::descriptorsOf(message);
        const std::vector<std::byte> whole = encode(message, 1, fds);
        for (int round = 0; round < 300; ++round) {
            std::vector<std::byte> bytes = whole;
            for (int change = 0; change <= round % 4; ++change) {
                bytes.at(random() % bytes.size()) = static_cast<std::byte>(random());
            }
            const Result<Decoded> decoded = decode(bytes, fds);
            if (!decoded) {
                EXPECT_EQ(decoded.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
                EXPECT_THAT(decoded.error().message(), HasSubstr("expected "));
                continue;
            }
            EXPECT_LE(encode(decoded.value().message, 1, fds).size(), kMaxMessage);
        }
    }
}

TEST(IsolateMessages, WhatIsFilledIsBounded) {
    Returned returned;
    auto stats = SluiceFrameStats{};
    stats.pass_count = SLUICE_MAX_PASSES + 1;
    returned.filled = stats;
    EXPECT_THAT(decode(encode(returned, 1, 0), 0).error().message(), HasSubstr("expected at most 32 passes, found 33"));

    stats.pass_count = SLUICE_MAX_PASSES;
    std::memset(&stats.passes[0].name[0], 'x', sizeof(stats.passes[0].name));
    returned.filled = stats;
    const Result<Decoded> decoded = decode(encode(returned, 1, 0), 0);
    ASSERT_TRUE(decoded) << decoded.error().message();
    const auto& found = std::get<SluiceFrameStats>(std::get<Returned>(decoded.value().message).filled);
    EXPECT_EQ(std::strlen(&found.passes[0].name[0]), sizeof(stats.passes[0].name) - 1);

    returned = Returned{};
    returned.result = 1000;
    EXPECT_THAT(decode(encode(returned, 1, 0), 0).error().message(), HasSubstr("expected a SluiceResult, found 1000"));
    returned.result = SLUICE_OK;
    returned.message = std::string("a\0b", 3);
    EXPECT_THAT(decode(encode(returned, 1, 0), 0).error().message(), HasSubstr("a text without a zero byte"));
    returned.message = std::string(kMaxText + 500, 'x');
    EXPECT_EQ(std::get<Returned>(decode(encode(returned, 1, 0), 0).value().message).message.size(), kMaxText);
}

}  // namespace
}  // namespace sluice::isolate
