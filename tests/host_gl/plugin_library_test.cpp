// SPDX-License-Identifier: MIT
#include "sluice/host_gl/plugin_library.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "gl_test.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/fd.hpp"
#include "sluice/host_gl/fluid_host.hpp"

namespace sluice::host::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::filesystem::path plugin(const std::string& name) {
    return std::filesystem::path(SLUICE_TEST_PLUGINS) / ("libsluice_test_" + name + ".so");
}

std::string loadError(const std::filesystem::path& path) {
    const Result<PluginLibrary> library = PluginLibrary::load(path);
    return library ? "loaded" : library.error().message();
}

TEST(PluginLibrary, NamesAMissingFile) {
    EXPECT_THAT(loadError("/nowhere/librenderer.so"),
                AllOf(HasSubstr("/nowhere/librenderer.so"), HasSubstr("does not exist"), HasSubstr("(give the path")));
}

TEST(PluginLibrary, NamesADirectory) {
    EXPECT_THAT(loadError("/tmp"), HasSubstr("is not a regular file"));
}

TEST(PluginLibrary, NamesAFileThatIsNoSharedObject) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "sluice_not_elf.so";
    std::ofstream(path) << "this is text";
    EXPECT_THAT(loadError(path),
                AllOf(HasSubstr("sluice_not_elf.so"), HasSubstr("cannot be loaded as a shared object")));
    std::filesystem::remove(path);
}

TEST(PluginLibrary, NamesAMissingEntrySymbol) {
    EXPECT_THAT(loadError(plugin("symbol")), HasSubstr("does not export 'sluice_renderer_entry'"));
}

TEST(PluginLibrary, NamesAnEntryWithoutTable) {
    EXPECT_THAT(loadError(plugin("table")), HasSubstr("does not serve ABI 1.3"));
}

TEST(PluginLibrary, NamesAnotherAbiMajor) {
    EXPECT_THAT(loadError(plugin("abi_major")), HasSubstr("expected ABI major 1, found 2"));
}

TEST(PluginLibrary, NamesATableThatIsTooShort) {
    EXPECT_THAT(loadError(plugin("short_table")), HasSubstr("expected a function table of at least"));
}

TEST(PluginLibrary, NamesTheFunctionThatIsNull) {
    EXPECT_THAT(loadError(plugin("null_function")), HasSubstr("NULL for 'submit_frame'"));
}

TEST(PluginLibrary, MovesItsHandle) {
    Result<PluginLibrary> library = PluginLibrary::load(plugin("no_images"));
    ASSERT_TRUE(library) << library.error().message();
    const PluginLibrary moved = std::move(library).value();
    EXPECT_EQ(moved.api().struct_size, sizeof(SluiceRendererApi));
    EXPECT_EQ(moved.path(), plugin("no_images"));
}

TEST(PluginLibrary, AProcessRefusesTheSamePluginsByNameAndDoesNotCrash) {
    struct Case {
        const char* name;
        const char* said;
    };
    for (const auto& [name, said] :
         {Case{"symbol", "does not export 'sluice_renderer_entry'"}, Case{"table", "does not serve ABI 1.3"},
          Case{"abi_major", "expected ABI major 1, found 2"},
          Case{"short_table", "expected a function table of at least"},
          Case{"null_function", "NULL for 'submit_frame'"}}) {
        IsolationConfig config;
        config.program = SLUICE_RENDERER_PROCESS;
        config.plugin = plugin(name);
        ::testing::internal::CaptureStderr();
        const Result<PluginLibrary> library = PluginLibrary::isolated(config);
        const std::string lines = ::testing::internal::GetCapturedStderr();
        ASSERT_FALSE(library) << name;
        EXPECT_THAT(library.error().message(), HasSubstr("ended with exit code 1 during its start"));
        EXPECT_THAT(lines, AllOf(HasSubstr(std::string("sluice-renderer: ") + plugin(name).string()), HasSubstr(said)));
        EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << lines;
    }
}

class BrokenRenderer : public GlTest {
  protected:
    static std::string createError(const std::string& name) {
        const Result<PluginLibrary> library = PluginLibrary::load(plugin(name));
        if (!library) {
            return "not loaded: " + library.error().message();
        }
        FluidHostConfig config;
        config.width = 32;
        config.height = 16;
        const Result<std::unique_ptr<FluidHost>> host = FluidHost::create(library.value(), config);
        return host ? "created" : host.error().message();
    }
};

TEST_F(BrokenRenderer, GarbageFromCreateBecomesOneLine) {
    const std::string message = createError("create_garbage");
    EXPECT_THAT(message, HasSubstr("renderer create: garbage"));
    EXPECT_EQ(message.find('\x01'), std::string::npos);
}

TEST_F(BrokenRenderer, SilentFailureOfCreateIsToldByItsCode) {
    EXPECT_THAT(createError("create_silent"), HasSubstr("failed with code -3 and no message"));
}

TEST_F(BrokenRenderer, PositiveCodeOfCreateIsAFailure) {
    EXPECT_THAT(createError("create_positive"), HasSubstr("failed with code 1"));
}

TEST_F(BrokenRenderer, SuccessWithoutRendererIsAFailure) {
    EXPECT_THAT(createError("create_null"), HasSubstr("returned no renderer"));
}

TEST_F(BrokenRenderer, ImagesThatWereNeverSharedAreNamed) {
    EXPECT_THAT(createError("no_images"), HasSubstr("HOST_DEPTH of set 0 was never shared"));
}

TEST_F(BrokenRenderer, AnAnswerShorterThanInAbiOneIsRefused) {
    EXPECT_THAT(createError("short_info"), HasSubstr("renderer info: struct_size is 12, at least 516 is needed"));
}

TEST_F(BrokenRenderer, ConfigOutOfRangeIsRefused) {
    const Result<PluginLibrary> library = PluginLibrary::load(plugin("no_images"));
    ASSERT_TRUE(library);
    FluidHostConfig config;
    config.width = 0;
    config.height = 16;
    EXPECT_THAT(FluidHost::create(library.value(), config).error().message(), HasSubstr("found 0x16"));
    config.width = 32;
    config.image_sets = 5;
    EXPECT_THAT(FluidHost::create(library.value(), config).error().message(), HasSubstr("expected 1..4, found 5"));
}

class BogusImport : public GlTest {};

TEST_F(BogusImport, FailsByNameAndLeavesTheDescriptorToTheCallerOverAHundredCycles) {
    const ProbeServices probe([](SluiceLogLevel, std::string_view) {});
    const SluiceHostServices& services = probe.services();
    const UniqueFd bogus(memfd_create("no device memory", MFD_CLOEXEC));
    ASSERT_TRUE(bogus.valid());
    ASSERT_EQ(ftruncate(bogus.get(), 1 << 20), 0);
    auto image = sized<SluiceImageExport>();
    image.role = SLUICE_IMAGE_FLUID_COLOUR;
    image.format = SLUICE_FORMAT_RGBA8;
    image.width = 67;
    image.height = 43;
    image.allocation_size = 1 << 20;
    image.fd = bogus.get();
    image.dedicated = 1;
    // The first call may make drivers open descriptors that they keep.
    auto error = sized<SluiceError>();
    EXPECT_EQ(services.share_image(services.user, &image, &error), SLUICE_ERROR_IMPORT);
    EXPECT_THAT(error.message, AllOf(HasSubstr("FLUID_COLOUR"), HasSubstr("67x43 RGBA8")));
    const int before = openDescriptors();
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(services.share_image(services.user, &image, &error), SLUICE_ERROR_IMPORT);
        EXPECT_NE(services.canary(services.user, &image, 1, &error), SLUICE_OK);
        ASSERT_NE(fcntl(bogus.get(), F_GETFD), -1) << "closed in cycle " << i;
    }
    EXPECT_EQ(openDescriptors(), before);
}

TEST_F(BogusImport, ImpossibleDescriptionsAreRefusedBeforeTheDriverSeesThem) {
    const ProbeServices probe([](SluiceLogLevel, std::string_view) {});
    const SluiceHostServices& services = probe.services();
    auto error = sized<SluiceError>();
    auto image = sized<SluiceImageExport>();
    image.role = SLUICE_IMAGE_FLUID_COLOUR;
    image.format = SLUICE_FORMAT_RGBA8;
    image.width = 67;
    image.height = 43;
    image.fd = 0;
    image.allocation_size = 67 * 43 * 4 - 1;
    EXPECT_EQ(services.share_image(services.user, &image, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error.message, HasSubstr("expected an allocation of at least 11524 bytes, found 11523"));
    image.format = 99;
    EXPECT_EQ(services.share_image(services.user, &image, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    image.format = SLUICE_FORMAT_RGBA8;
    image.allocation_size = 1 << 20;
    image.fd = -1;
    EXPECT_EQ(services.share_image(services.user, &image, &error), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error.message, HasSubstr("file descriptor -1"));
    services.retire_image(services.user, 99, 99);  // must be harmless
    EXPECT_NE(fcntl(0, F_GETFD), -1);
}

}  // namespace
}  // namespace sluice::host::test
