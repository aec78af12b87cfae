// SPDX-License-Identifier: MIT
// When the user is told that OpenGL does not use the graphics card.
#include <gtest/gtest.h>

#include "context/device_choice.hpp"

namespace sluice::host::test {
namespace {

constexpr const char* kLlvmpipe = "llvmpipe (LLVM 15.0.6, 256 bits)";
const std::vector<bool> kCardSecond{true, false};

TEST(GlDeviceNote, NamesTheFirstDeviceThatIsNoSoftware) {
    EXPECT_EQ(deviceNote(kLlvmpipe, "", kCardSecond),
              "OpenGL is the software renderer 'llvmpipe (LLVM 15.0.6, 256 bits)' although EGL device 1 is none; set "
              "SLUICE_GL_DEVICE=1 to use it");
    EXPECT_NE(deviceNote("softpipe", "", {false, true, false}).find("SLUICE_GL_DEVICE=0 "), std::string::npos);
}

TEST(GlDeviceNote, IsEmptyWhereNothingIsToBeGained) {
    EXPECT_EQ(deviceNote("NVIDIA H200/PCIe/SSE2", "", kCardSecond), "");
    EXPECT_EQ(deviceNote(kLlvmpipe, "", {true}), "");
    EXPECT_EQ(deviceNote(kLlvmpipe, "", {}), "");
}

TEST(GlDeviceNote, IsEmptyForWhoAskedForTheSoftwareRenderer) {
    EXPECT_EQ(deviceNote(kLlvmpipe, "surfaceless", kCardSecond), "");
    EXPECT_EQ(deviceNote(kLlvmpipe, "0", kCardSecond), "");
}

TEST(GlDeviceNote, TellsThatTheDeviceAskedForDoesNotDraw) {
    EXPECT_EQ(
        deviceNote(kLlvmpipe, "1", kCardSecond),
        "SLUICE_GL_DEVICE=1 names an EGL device that is no software renderer, but OpenGL on it is 'llvmpipe (LLVM "
        "15.0.6, 256 bits)'; install the OpenGL driver of that device, or unset the variable");
    EXPECT_EQ(deviceNote("NVIDIA H200/PCIe/SSE2", "1", kCardSecond), "");
}

}  // namespace
}  // namespace sluice::host::test
