// SPDX-License-Identifier: MIT
#include "sluice/host_gl/context.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "context/device_choice.hpp"
#include "context/egl_devices.hpp"
#include "gl_test.hpp"
#include "share/gl_errors.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/host_gl/state_snapshot.hpp"

namespace sluice::host::test {
namespace {

using Capabilities = GlTest;

TEST(GlContext, IsCompatibilityOpenGlOfAtLeast21) {
    auto context = GlContext::create();
    ASSERT_TRUE(context.ok()) << context.error().message();
    ASSERT_TRUE(context.value().makeCurrent().ok());
    EXPECT_GE(epoxy_gl_version(), 21);
    const auto screen = Screen::create(1, 1);
    ASSERT_TRUE(screen.ok());
    screen.value().bind();
    glBegin(GL_TRIANGLES);
    glEnd();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "the fixed function is missing";
}

TEST(GlContext, FiftyOfThemLeaveNoDescriptorOpen) {
    {
        // The driver keeps a few descriptors of its own from the first context on.
        auto warm = GlContext::create();
        ASSERT_TRUE(warm.ok());
    }
    const int before = openDescriptors();
    for (int i = 0; i < 50; ++i) {
        auto context = GlContext::create();
        ASSERT_TRUE(context.ok()) << context.error().message();
        ASSERT_TRUE(context.value().makeCurrent().ok());
    }
    EXPECT_EQ(openDescriptors(), before);
}

TEST(GlContext, OneSurvivesTheEndOfAnother) {
    auto first = GlContext::create();
    ASSERT_TRUE(first.ok());
    {
        auto second = GlContext::create();
        ASSERT_TRUE(second.ok());
        ASSERT_TRUE(second.value().makeCurrent().ok());
    }
    // Both are on one EGLDisplay: a premature eglTerminate would make this fail.
    ASSERT_TRUE(first.value().makeCurrent().ok());
    EXPECT_NE(glGetString(GL_VENDOR), nullptr);
}

TEST(GlContext, SharedContextSeesTexturesOnAnotherThread) {
    auto first = GlContext::create();
    ASSERT_TRUE(first.ok());
    ASSERT_TRUE(first.value().makeCurrent().ok());
    const std::array<std::uint8_t, 4> red{255, 0, 0, 255};
    const TestTexture texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 1, 1, red.data());
    glFinish();
    auto shared = first.value().createShared();
    ASSERT_TRUE(shared.ok()) << shared.error().message();
    std::array<std::uint8_t, 4> seen{};
    bool current = false;
    std::thread reader([&] {
        current = shared.value().makeCurrent().ok();
        glBindTexture(GL_TEXTURE_2D, texture.name());
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, seen.data());
        shared.value().release();
    });
    reader.join();
    EXPECT_TRUE(current);
    EXPECT_EQ(seen, red);
    EXPECT_NE(glGetString(GL_VENDOR), nullptr) << "this thread lost its context";
}

TEST(GlContext, SharedContextOutlivesTheOneItWasMadeFrom) {
    auto first = std::make_unique<Result<GlContext>>(GlContext::create());
    ASSERT_TRUE(first->ok());
    auto shared = first->value().createShared();
    ASSERT_TRUE(shared.ok());
    first.reset();
    EXPECT_TRUE(shared.value().makeCurrent().ok());
    EXPECT_NE(glGetString(GL_VERSION), nullptr);
}

TEST(GlContext, CurrentElsewhereIsAnErrorThatNamesTheCall) {
    auto context = GlContext::create();
    ASSERT_TRUE(context.ok());
    ASSERT_TRUE(context.value().makeCurrent().ok());
    std::string message;
    std::thread other([&] {
        const Status status = context.value().makeCurrent();
        message = status.ok() ? "" : status.error().message();
    });
    other.join();
    EXPECT_NE(message.find("eglMakeCurrent: EGL_BAD_ACCESS (0x3002)"), std::string::npos) << message;
}

TEST_F(Capabilities, NameTheDriverAndItsUuids) {
    const SluiceHostCapabilities caps = queryCapabilities();
    EXPECT_EQ(caps.struct_size, sizeof(caps));
    EXPECT_GT(std::strlen(&caps.renderer[0]), 0U);
    EXPECT_GT(std::strlen(&caps.version[0]), 0U);
    if (caps.has_memory_object == 0) {
        GTEST_SKIP() << "this driver has no GL_EXT_memory_object";
    }
    EXPECT_GE(caps.device_uuid_count, 1U);
    const auto set = [](const std::uint8_t(&uuid)[SLUICE_UUID_SIZE]) {
        return std::any_of(std::begin(uuid), std::end(uuid), [](std::uint8_t byte) { return byte != 0; });
    };
    EXPECT_TRUE(set(caps.device_uuids[0]));
    EXPECT_TRUE(set(caps.driver_uuid));
}

TEST_F(Capabilities, OfLlvmpipeAreTheMeasuredOnes) {
    const SluiceHostCapabilities caps = queryCapabilities();
    if (std::string_view(&caps.renderer[0]).find("llvmpipe") == std::string_view::npos) {
        GTEST_SKIP() << "not llvmpipe: " << &caps.renderer[0];
    }
    EXPECT_EQ(caps.has_memory_object, 1U);
    EXPECT_EQ(caps.has_memory_object_fd, 1U);
    EXPECT_EQ(caps.has_timeline_semaphore, 0U);
    EXPECT_EQ(caps.has_sync, 1U);
    EXPECT_EQ(caps.has_framebuffer_object, 1U);
    for (const FormatInfo& format : formatTable()) {
        EXPECT_NE(caps.texture_formats & formatBit(format.format), 0U) << format.name;
        EXPECT_NE(caps.attachment_formats & formatBit(format.format), 0U) << format.name;
    }
}

TEST_F(Capabilities, QueryLeavesStateAndErrorFlagClean) {
    const TestTexture texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 2, 2, nullptr);
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
    const StateSnapshot before = takeStateSnapshot();
    (void)queryCapabilities();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    EXPECT_TRUE(differences(before, takeStateSnapshot()).empty());
}

TEST(GlDevice, IsSurfacelessUnlessAnIndexIsGiven) {
    EXPECT_EQ(parseGlDevice("").value(), std::nullopt);
    EXPECT_EQ(parseGlDevice("surfaceless").value(), std::nullopt);
    EXPECT_EQ(parseGlDevice("0").value(), 0U);
    EXPECT_EQ(parseGlDevice("12").value(), 12U);
}

TEST(GlDevice, OfABadValueIsRefusedByNameValueAndRemedy) {
    for (const char* bad : {"nvidia", "-1", "1 ", " 1", "0x1", "1.0", "99999999999999999999999"}) {
        const auto choice = parseGlDevice(bad);
        ASSERT_FALSE(choice) << bad;
        EXPECT_EQ(choice.error().message(),
                  "SLUICE_GL_DEVICE: expected 'surfaceless' or the index of an EGL device, found '" + std::string(bad) +
                      "' (see the list of EGL devices in 'sluice probe', or unset the variable)");
    }
}

/// Sets SLUICE_GL_DEVICE for a scope.
class DeviceVariable {
  public:
    explicit DeviceVariable(const std::string& value) {
        if (const char* before = std::getenv(kGlDeviceVariable)) {
            before_ = before;
        }
        setenv(kGlDeviceVariable, value.c_str(), 1);
    }
    DeviceVariable(const DeviceVariable&) = delete;
    DeviceVariable& operator=(const DeviceVariable&) = delete;
    ~DeviceVariable() {
        if (before_) {
            setenv(kGlDeviceVariable, before_->c_str(), 1);
        } else {
            unsetenv(kGlDeviceVariable);
        }
    }

  private:
    std::optional<std::string> before_;
};

TEST(GlDevice, EveryListedIndexOpensOrSaysWhyAndTheNextOneDoesNotExist) {
    const std::vector<std::string> lines = eglDevices();
    const std::vector<EGLDeviceEXT> devices = listEglDevices();
    ASSERT_EQ(lines.size(), devices.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i].rfind(std::to_string(i) + ": ", 0), 0U) << lines[i];
        EXPECT_NE(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), nullptr) << "no device at all";
        const DeviceVariable variable(std::to_string(i));
        const auto context = GlContext::create();
        if (context || isSoftwareDevice(devices[i])) {
            ASSERT_TRUE(context) << context.error().message();
            EXPECT_TRUE(context.value().makeCurrent().ok());
        } else {
            EXPECT_NE(context.error().message().find("device " + std::to_string(i)), std::string::npos)
                << context.error().message();
        }
    }
    const DeviceVariable variable(std::to_string(lines.size()));
    const auto none = GlContext::create();
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message().find("SLUICE_GL_DEVICE: there is no EGL device " + std::to_string(lines.size())),
              std::string::npos)
        << none.error().message();
}

TEST(GlDevice, OfABadVariableFailsTheContext) {
    const DeviceVariable variable("card0");
    const auto context = GlContext::create();
    ASSERT_FALSE(context);
    EXPECT_NE(context.error().message().find("found 'card0'"), std::string::npos);
}

TEST_F(Capabilities, NoteNamesTheVariableOnlyWhereAnotherDeviceExists) {
    const std::vector<EGLDeviceEXT> devices = listEglDevices();
    const bool hardware = std::any_of(devices.begin(), devices.end(), [](auto d) { return !isSoftwareDevice(d); });
    const SluiceHostCapabilities caps = queryCapabilities();
    const bool software = std::string_view(&caps.renderer[0]).find("llvmpipe") != std::string_view::npos;
    const DeviceVariable unset("");
    const std::string note = glDeviceNote();
    EXPECT_EQ(note.find("set SLUICE_GL_DEVICE=") != std::string::npos, hardware && software) << note;
    EXPECT_EQ(note.empty(), !(hardware && software)) << note;
}

class ErrorScope : public GlTest {};

TEST_F(ErrorScope, TellsItsOwnErrorsFromTheHostsAndLeavesThoseAsFound) {
    while (glGetError() != GL_NO_ERROR) {
    }
    constexpr std::array<GLenum, 5> kFlags{GL_NO_ERROR, GL_INVALID_ENUM, GL_INVALID_VALUE, GL_INVALID_OPERATION,
                                           GL_INVALID_FRAMEBUFFER_OPERATION};
    for (const GLenum hosts : kFlags) {
        SCOPED_TRACE(hosts);
        const auto raiseHosts = [hosts] {
            GLuint framebuffer = 0;
            switch (hosts) {
                case GL_INVALID_ENUM:
                    glMatrixMode(GL_RGBA);
                    break;
                case GL_INVALID_VALUE:
                    glLineWidth(-1.0F);
                    break;
                case GL_INVALID_OPERATION:
                    glEnd();
                    break;
                case GL_INVALID_FRAMEBUFFER_OPERATION:
                    glGenFramebuffers(1, &framebuffer);
                    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
                    glClear(GL_COLOR_BUFFER_BIT);
                    glDeleteFramebuffers(1, &framebuffer);
                    break;
                default:
                    break;
            }
        };
        raiseHosts();
        ASSERT_EQ(glGetError(), hosts);
        raiseHosts();
        const StateSnapshot before = [] {
            const GlErrorScope aside;
            return takeStateSnapshot();
        }();
        {
            const GlErrorScope errors;
            EXPECT_EQ(GlErrorScope::take(), "");
            glLineWidth(-1.0F);
            EXPECT_EQ(GlErrorScope::take(), "GL_INVALID_VALUE (0x0501)");
            EXPECT_EQ(GlErrorScope::take(), "");
            glLineWidth(-1.0F);  // not taken: dropped, and not the host's
        }
        EXPECT_EQ(glGetError(), hosts);
        EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
        EXPECT_TRUE(differences(before, takeStateSnapshot()).empty());
    }
}

}  // namespace
}  // namespace sluice::host::test
