// SPDX-License-Identifier: MIT
// A host, the real renderer and frames that say which frame they are.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sluice/host_gl/context.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "sluice/host_gl/plugin_library.hpp"
#include "sluice/host_gl/screen.hpp"

namespace sluice::host::test {

constexpr std::uint32_t kEchoWidth = 259;  // odd and above one 256-texel row
constexpr std::uint32_t kEchoHeight = 131;

/// What the two halves of the picture of one frame hold: colour in units of 1/255, window depth.
struct Stamp {
    std::array<std::uint8_t, 4> colour;
    float depth;
};
/// `half` 0 is the left half. Stamps of neighbouring frames differ in every colour channel but alpha, and in depth.
[[nodiscard]] Stamp stampOf(std::uint64_t frame, int half);

/// Fills the screen with `layers` quads of other colours and depths and then with the frame's stamp.
void drawStamp(const Screen& screen, std::uint64_t frame, int layers);

/// Texels of the fluid images that do not hold the stamp of `frame`.
struct Verdict {
    std::size_t wrong_colour = 0, wrong_depth = 0, texels = 0;
    /// Texels whose colour and depth are both those of an earlier frame, a subset of the wrong ones.
    std::size_t stale = 0;
    [[nodiscard]] bool clean() const { return wrong_colour == 0 && wrong_depth == 0; }
};
[[nodiscard]] Verdict inspect(const FluidHost& host, std::uint64_t frame);
/// The same of any two textures of the fluid images' size and formats.
[[nodiscard]] Verdict inspect(const SluiceRendererInfo& info, std::uint32_t colour, std::uint32_t depth,
                              std::uint64_t frame);

/// A frame that asks for SLUICE_VIEW_ECHO.
[[nodiscard]] FrameInput echoInput();

/// Context, library and whatever host a test makes, in the order in which they must die.
class EchoTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;
    /// Fails the test if there is no host.
    void makeHost(const FluidHostConfig& config);
    [[nodiscard]] FluidHostConfig config() const;
    void makeScreen(std::uint32_t width, std::uint32_t height);
    /// One frame of the host on the screen, checked texel by texel.
    void frameIsClean();

    std::optional<GlContext> context_;
    std::optional<PluginLibrary> library_;
    std::unique_ptr<FluidHost> host_;
    std::optional<Screen> screen_;
    std::vector<std::string> complaints_;  ///< warnings and errors that were logged
};

}  // namespace sluice::host::test
