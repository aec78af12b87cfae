// SPDX-License-Identifier: MIT
// What the process keeps of frames that are done. Not under sanitizers, which keep freed memory back.
#ifndef SLUICE_SANITIZED
#include <malloc.h>
#include <unistd.h>

#include <fstream>

#include "core_live_rig.hpp"

namespace sluice::vk::test {
namespace {

std::int64_t residentBytes() {
    std::int64_t all = 0;
    std::int64_t resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * ::sysconf(_SC_PAGESIZE);
}

/// A shader that lavapipe compiled anew for each frame was kept with 400 KiB (docs/results/retrofit.md); without one,
/// noise stays below two MiB.
class Growth : public LiveFluid {
  protected:
    static constexpr std::uint64_t kWarm = 60, kFrames = 200;
    static constexpr std::int64_t kMost = 8 << 20;

    /// Frames of value k, or of uploaded particles, and by how much the process grows once it is warm.
    std::int64_t grown(bool live, float foam, std::uint32_t flags) {
        ::malloc_trim(0);  // or this would fill what the test before has left
        std::int64_t warm = 0;
        for (std::uint64_t k = 1; k <= kWarm + kFrames; ++k) {
            SluiceFrame frame = frameOf(k, 2, SLUICE_VIEW_FLUID);
            frame.flags = flags;
            if (live) {
                EXPECT_EQ(simulate(k, k == 1 ? 0.0 : kFrame / 2.0), SLUICE_OK) << said.message;
                frame.simulation = k;
                frame.fluid.ellipsoids = 1;
                frame.fluid.foam = foam;
            }
            EXPECT_EQ(renderer->submit(frame), SLUICE_OK) << renderer->error().message;
            EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value), SLUICE_OK);
            EXPECT_EQ(api().timeline_wait(renderer->get(), k, kLong), SLUICE_OK);
            EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value + 1), SLUICE_OK);
            warm = k == kWarm ? residentBytes() : warm;
        }
        return residentBytes() - warm;
    }
};

TEST_F(Growth, FramesThatReflectAndRefractLeaveNothingBehind) {
    ASSERT_NO_FATAL_FAILURE(start(Block(), false, false));
    const ParticleCloud cloud(200);
    ASSERT_EQ(api().set_particles(renderer->get(), &cloud.particles, nullptr), SLUICE_OK);
    EXPECT_LT(grown(false, 0.0F, 0), kMost);
}

TEST_F(Growth, AFluidThatFlowsFoamsAndMeetsWhatIsSeenLeavesNothingBehind) {
    Block block;
    block.simulation.anisotropy = 4.0F;
    block.simulation.lonely = 1.0F;
    block.simulation.foam_life = 0.5F;
    block.simulation.foam_air[1] = block.simulation.foam_energy[1] = 0.01F;
    block.simulation.depth_scale = 2;
    for (const float foam : {0.0F, 1.0F}) {  // each has a shader of its own
        ASSERT_NO_FATAL_FAILURE(start(block, false, false));
        EXPECT_LT(grown(true, foam, SLUICE_FRAME_CAPTURE_DEPTH), kMost) << foam;
        EXPECT_EQ(stats().failed, 0U) << stats().message;
    }
}

}  // namespace
}  // namespace sluice::vk::test
#endif
