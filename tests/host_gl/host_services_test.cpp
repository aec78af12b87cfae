// SPDX-License-Identifier: MIT
// What a renderer may call, called wrongly: each struct is refused below the size that it has in ABI 1.0.
#include "frame/host_services.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "gl_test.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr auto kLastShortExport = static_cast<std::uint32_t>(kAbiMinimum<SluiceImageExport> - 1);
constexpr auto kLastShortEvent = static_cast<std::uint32_t>(kAbiMinimum<SluiceTraceEvent> - 1);
constexpr auto kLastShortError = static_cast<std::uint32_t>(kAbiMinimum<SluiceError> - 1);

class HostServicesTest : public GlTest {
  protected:
    /// Right in all but its descriptor, which no service may touch.
    static SluiceImageExport standardInput() {
        auto image = sized<SluiceImageExport>();
        image.role = SLUICE_IMAGE_FLUID_COLOUR;
        image.format = SLUICE_FORMAT_RGBA8;
        image.width = 67;
        image.height = 43;
        image.allocation_size = 1 << 20;
        image.fd = STDIN_FILENO;
        return image;
    }

    Trace trace_{8};
    std::vector<std::string> log_;
    HostServices services_{[this](SluiceLogLevel, std::string_view text) { log_.emplace_back(text); }, &trace_};
    const SluiceHostServices& table_ = services_.table();
};

TEST_F(HostServicesTest, AnExportShorterThanInAbiOneIsRefusedByItsSize) {
    SluiceImageExport image = standardInput();
    for (const std::uint32_t size : {0U, 4U, 32U, kLastShortExport}) {
        image.struct_size = size;
        const std::string told = "image: struct_size is " + std::to_string(size) + ", at least 40 is needed";
        auto error = sized<SluiceError>();
        EXPECT_EQ(table_.share_image(table_.user, &image, &error), SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(error.message, HasSubstr(told));
        error = sized<SluiceError>();
        EXPECT_EQ(table_.canary(table_.user, &image, 1, &error), SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(error.message, HasSubstr(told));
    }
    EXPECT_NE(fcntl(STDIN_FILENO, F_GETFD), -1);
}

TEST_F(HostServicesTest, NullIsRefusedByName) {
    const SluiceImageExport image = standardInput();
    auto error = sized<SluiceError>();
    EXPECT_EQ(table_.share_image(table_.user, nullptr, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error.message, HasSubstr("image: it is NULL"));
    EXPECT_EQ(table_.canary(table_.user, nullptr, 1, nullptr), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(table_.share_image(nullptr, &image, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error.message, HasSubstr("user: it is NULL (pass SluiceHostServices::user)"));
    table_.retire_image(nullptr, 0, 0);
    table_.log(nullptr, SLUICE_LOG_INFO, "lost");
    table_.trace(table_.user, nullptr);
    EXPECT_THAT(log_, IsEmpty());
}

TEST_F(HostServicesTest, AnErrorStructTooShortForItsMessageIsRefusedBeforeAnythingIsDone) {
    const SluiceImageExport image = standardInput();
    SluiceError error{};
    error.struct_size = kLastShortError;
    EXPECT_EQ(table_.share_image(table_.user, &image, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error.code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error.message, HasSubstr("error: struct_size is 519, at least 520 is needed"));
    error = SluiceError{};
    EXPECT_EQ(table_.canary(table_.user, &image, 1, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(error.code, 0) << "a struct of size 0 has no room for a code";
}

TEST_F(HostServicesTest, ShortTraceEventsAreDroppedCountedAndToldOnce) {
    auto event = sized<SluiceTraceEvent>();
    event.kind = SLUICE_TRACE_MARK;
    event.name = "whole";
    table_.trace(table_.user, &event);
    for (const std::uint32_t size : {0U, 12U, kLastShortEvent}) {
        event.struct_size = size;
        table_.trace(table_.user, &event);
    }
    EXPECT_EQ(trace_.drain().size(), 1U);
    EXPECT_EQ(trace_.dropped(), 3U);
    EXPECT_THAT(log_, ElementsAre(AllOf(HasSubstr("trace event: struct_size is 0, at least 64 is needed"),
                                        HasSubstr("dropped"))));
}

TEST_F(HostServicesTest, TraceEventsOfUnknownKindsAreCountedAsDropped) {
    auto event = sized<SluiceTraceEvent>();
    event.kind = SLUICE_TRACE_KIND_COUNT;
    table_.trace(table_.user, &event);
    event.kind = SLUICE_TRACE_MARK;
    event.name = nullptr;  // a name is no condition
    table_.trace(table_.user, &event);
    EXPECT_EQ(trace_.drain().size(), 1U);
    EXPECT_EQ(trace_.dropped(), 1U);
    EXPECT_THAT(log_, IsEmpty());
}

}  // namespace
}  // namespace sluice::host::test
