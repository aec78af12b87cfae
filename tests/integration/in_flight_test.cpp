// SPDX-License-Identifier: MIT
// Frames that are really in flight: nothing is read back in the loop. Each frame's fluid images are copied on the GPU
// into textures of its own, which are looked at after the run.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <tuple>
#include <vector>

#include "gl_test.hpp"
#include "shim_rig.hpp"
#include "sluice/format.hpp"

namespace sluice::host::test {
namespace {

constexpr std::uint32_t kWidth = 67;
constexpr std::uint32_t kHeight = 43;
constexpr std::uint64_t kFrames = 64;
constexpr int kTries = 20;
constexpr int kMostLayers = 432;  // more only makes a try longer

/// A bad frame is stale if every texel is that of an earlier frame.
struct Tally {
    std::uint64_t frames = 0, bad = 0, stale = 0;
};

const FormatInfo& formatOf(const SluiceRendererInfo& info, SluiceImageRole role) {
    return *findFormat(info.formats[role]);
}

/// A frame's fluid images, copied.
struct Kept {
    Kept(std::uint64_t number, const FormatInfo& colour_format, const FormatInfo& depth_format)
        : frame(number),
          colour(colour_format.gl_internal, colour_format.gl_transfer_format, colour_format.gl_transfer_type, kWidth,
                 kHeight, nullptr),
          depth(depth_format.gl_internal, depth_format.gl_transfer_format, depth_format.gl_transfer_type, kWidth,
                kHeight, nullptr) {}
    std::uint64_t frame;
    TestTexture colour, depth;
};

class InFlightTest : public ShimTest {
  protected:
    void start(SluiceTimelineKind timeline, std::uint32_t sets) {
        FluidHostConfig wanted = config();
        wanted.width = kWidth;
        wanted.height = kHeight;
        wanted.image_sets = sets;
        wanted.timeline = timeline;
        ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
        ASSERT_NO_FATAL_FAILURE(makeScreen(kWidth, kHeight));
    }

    /// Submits as many frames as there are sets before it composites the last of them, whose value implies the others';
    /// then keeps them all.
    void run(int layers, std::uint32_t flags, Tally& tally) {
        const std::uint32_t sets = host_->info().image_sets;
        FrameInput input = echoInput();
        input.flags = flags;
        std::vector<std::unique_ptr<Kept>> kept;
        GLuint reader = 0;
        glGenFramebuffers(1, &reader);
        for (std::uint64_t done = 0; done < kFrames; done += sets) {
            std::vector<std::array<std::uint32_t, 2>> images;
            for (std::uint32_t i = 0; i < sets; ++i) {
                drawStamp(*screen_, host_->frame() + 1, layers);
                const Status submitted = host_->submit(*screen_, input);
                ASSERT_TRUE(submitted) << submitted.error().message();
                images.push_back({host_->texture(SLUICE_IMAGE_FLUID_COLOUR), host_->texture(SLUICE_IMAGE_FLUID_DEPTH)});
            }
            const Status composited = host_->composite(*screen_);
            ASSERT_TRUE(composited) << composited.error().message();
            for (std::uint32_t i = 0; i < sets; ++i) {
                kept.push_back(std::make_unique<Kept>(host_->frame() + 1 - sets + i,
                                                      formatOf(host_->info(), SLUICE_IMAGE_FLUID_COLOUR),
                                                      formatOf(host_->info(), SLUICE_IMAGE_FLUID_DEPTH)));
                copy(reader, images[i][0], kept.back()->colour.name());
                copy(reader, images[i][1], kept.back()->depth.name());
            }
        }
        glDeleteFramebuffers(1, &reader);
        for (const std::unique_ptr<Kept>& frame : kept) {
            const Verdict verdict = inspect(host_->info(), frame->colour.name(), frame->depth.name(), frame->frame);
            ASSERT_EQ(verdict.texels, std::size_t{kWidth} * kHeight);
            ++tally.frames;
            tally.bad += verdict.clean() ? 0U : 1U;
            tally.stale += verdict.stale == verdict.texels ? 1U : 0U;
        }
    }

    /// More work per frame and a new host each time, until a frame is bad.
    void lose(SluiceTimelineKind timeline, std::uint32_t flags, bool drop_host_wait, const char* what) {
        Tally tally;
        int layers = 16;
        for (int i = 0; i < kTries && tally.bad == 0; ++i, layers = std::min(3 * layers, kMostLayers)) {
            host_.reset();
            control_->drop_host_wait = false;
            ASSERT_NO_FATAL_FAILURE(start(timeline, 2));
            control_->drop_host_wait = drop_host_wait;
            ASSERT_NO_FATAL_FAILURE(run(layers, flags, tally));
        }
        control_->drop_host_wait = false;
        EXPECT_GT(tally.bad, 0U) << what << ": " << tally.frames << " frames";
        std::printf("%s: %llu of %llu frames bad, %llu stale\n", what, static_cast<unsigned long long>(tally.bad),
                    static_cast<unsigned long long>(tally.frames), static_cast<unsigned long long>(tally.stale));
    }

  private:
    static void copy(GLuint reader, std::uint32_t from, std::uint32_t to) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, reader);
        glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, from, 0);
        glReadBuffer(GL_COLOR_ATTACHMENT0);
        glBindTexture(GL_TEXTURE_2D, to);
        glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, static_cast<GLsizei>(kWidth), static_cast<GLsizei>(kHeight));
        glBindTexture(GL_TEXTURE_2D, 0);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    }
};

class SynchronisedInFlight : public InFlightTest,
                             public ::testing::WithParamInterface<std::tuple<SluiceTimelineKind, std::uint32_t>> {};

TEST_P(SynchronisedInFlight, EveryFrameKeptOnTheGpuIsItsOwn) {
    const auto [timeline, sets] = GetParam();
    ASSERT_NO_FATAL_FAILURE(start(timeline, sets));
    ASSERT_EQ(host_->info().timeline, static_cast<std::uint32_t>(timeline));
    Tally tally;
    ASSERT_NO_FATAL_FAILURE(run(48, 0, tally));
    EXPECT_EQ(tally.frames, kFrames);
    EXPECT_EQ(tally.bad, 0U) << tally.stale << " stale";
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "a copy was refused";
}

INSTANTIATE_TEST_SUITE_P(Software, SynchronisedInFlight,
                         ::testing::Combine(::testing::Values(SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH),
                                            ::testing::Values(1U, 2U, 4U)),
                         [](const auto& param) {
                             return std::string(toString(std::get<0>(param.param))) +
                                    std::to_string(std::get<1>(param.param));
                         });

TEST_F(InFlightTest, WithoutTheRenderersWaitFramesAreBad) {
    lose(SLUICE_TIMELINE_BRIDGED, SLUICE_FRAME_SKIP_WAIT, false, "only the renderer's wait dropped");
}

TEST_F(InFlightTest, WithoutTheHostsWaitFramesAreBad) {
    lose(SLUICE_TIMELINE_BRIDGED, 0, true, "only the host's wait dropped");
}

}  // namespace
}  // namespace sluice::host::test
