// SPDX-License-Identifier: MIT
// A fluid inside the renderer whose particles are ellipsoids: what frames draw of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "core_live_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

class LiveShape : public LiveFluid {
  protected:
    /// Depths that the frame of each value shows, after so many of them.
    std::vector<float> depths(const Block& block, bool ellipsoids, std::uint64_t values = 4) {
        start(block);
        std::vector<float> out;
        for (std::uint64_t k = 1; k <= values; ++k) {
            EXPECT_EQ(simulate(k, k == 1 ? 0.0 : kFrame), SLUICE_OK) << said.message;
            SluiceFrame frame = frameOf(k, 2, SLUICE_VIEW_FLUID);
            frame.simulation = k;
            frame.fluid.ellipsoids = ellipsoids ? 1U : 0U;
            EXPECT_EQ(renderer->submit(frame), SLUICE_OK) << renderer->error().message;
            EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value), SLUICE_OK);
            EXPECT_EQ(api().timeline_wait(renderer->get(), k, kLong), SLUICE_OK);
            EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value + 1), SLUICE_OK);
            const std::vector<std::byte> texels = host->texels(SLUICE_IMAGE_FLUID_DEPTH, frame.image_set);
            const std::size_t before = out.size();
            out.resize(before + texels.size() / sizeof(float));
            std::memcpy(&out[before], texels.data(), texels.size());
        }
        EXPECT_EQ(stats().failed, 0U) << stats().message;
        EXPECT_EQ(frameStats(values).validation_messages, 0U);
        return out;
    }
};

/// Share of texels of the fluid that differ by more than a millimetre, which two metres away is this.
double different(const std::vector<float>& a, const std::vector<float>& b) {
    EXPECT_EQ(a.size(), b.size());
    std::size_t fluid = 0;
    std::size_t other = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        fluid += a[i] < 1.0F || b[i] < 1.0F ? 1U : 0U;
        other += std::abs(a[i] - b[i]) > 2.5e-5F ? 1U : 0U;
    }
    EXPECT_GT(fluid, 100U);
    return static_cast<double>(other) / static_cast<double>(fluid);
}

TEST_F(LiveShape, RoundOnesAreTheSpheresAndStretchedOnesAreNotAndAFrameMayAskForSpheres) {
    Block block;
    const std::vector<float> spheres = depths(block, true);
    block.simulation.anisotropy = 1.0F;
    block.simulation.lonely = 1.0F;
    EXPECT_LT(different(depths(block, true), spheres), 0.01) << "but for outlines";
    block.simulation.anisotropy = 4.0F;
    EXPECT_GT(different(depths(block, true), spheres), 0.02);
    EXPECT_EQ(depths(block, false), spheres);
}

/// Who goes leaves a gap in the identities: a shape in the wrong place would be a hole, and another elsewhere.
TEST_F(LiveShape, HaveThePlacesOfTheirParticlesWhenSomeComeAndGo) {
    Block block(2);
    SluiceEmitter emitter{};
    emitter.shape = SLUICE_OPENING_DISC;
    emitter.centre[1] = 0.7F;
    emitter.centre[2] = -2.0F;
    emitter.direction[1] = -1.0F;
    emitter.width = emitter.height = 0.2F;
    emitter.speed = 3.0F;
    SluiceDrain drain{};
    drain.shape = SLUICE_REGION_BOX;
    drain.centre[1] = -0.25F;
    drain.centre[2] = -2.0F;
    drain.half[0] = 0.1F;
    drain.half[1] = 0.15F;
    drain.half[2] = 0.5F;
    block.simulation.emitters = &emitter;
    block.simulation.drains = &drain;
    block.simulation.emitter_count = block.simulation.drain_count = 1;
    block.simulation.max_particles = 1000;
    const std::vector<float> spheres = depths(block, true);
    EXPECT_NE(stats().particle_count, block.simulation.particle_count);
    block.simulation.anisotropy = block.simulation.lonely = 1.0F;
    EXPECT_LT(different(depths(block, true), spheres), 0.01);
}

TEST_F(LiveShape, FoamIsDrawnWhereItIsMadeAndAFrameThatAsksForNoneHasItsBits) {
    Block block;
    const auto draw = [&](std::uint64_t k, double seconds, float foam) {
        EXPECT_EQ(simulate(k, seconds), SLUICE_OK) << said.message;
        SluiceFrame frame = frameOf(k, 2, SLUICE_VIEW_FLUID);
        frame.simulation = k;
        frame.fluid.foam = foam;
        EXPECT_EQ(renderer->submit(frame), SLUICE_OK) << renderer->error().message;
        EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value), SLUICE_OK);
        EXPECT_EQ(api().timeline_wait(renderer->get(), k, kLong), SLUICE_OK);
        EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value + 1), SLUICE_OK);
        return host->texels(SLUICE_IMAGE_FLUID_COLOUR, frame.image_set);
    };
    const auto pictures = [&](const Block& of, float foam) {
        start(of);
        std::vector<std::vector<std::byte>> out;
        for (std::uint64_t k = 1; k <= 5; ++k) {
            out.push_back(draw(k, k == 1 ? 0.0 : kFrame, foam));
        }
        EXPECT_EQ(stats().failed, 0U) << stats().message;
        EXPECT_EQ(frameStats(5).validation_messages, 0U);
        return out;
    };
    const auto passes = [&] {
        std::string names;
        const SluiceFrameStats found = frameStats(5);
        for (std::uint32_t i = 0; i < found.pass_count; ++i) {
            names += std::string(&found.passes[i].name[0]) + " ";
        }
        return names;
    };
    const auto clear = pictures(block, 1.0F);
    EXPECT_THAT(passes(), ::testing::Not(HasSubstr("splat_foam"))) << "none is made";
    block.simulation.foam_life = 0.5F;
    block.simulation.foam_air[1] = block.simulation.foam_energy[1] = 0.01F;
    EXPECT_EQ(pictures(block, 0.0F), clear);
    EXPECT_THAT(passes(), ::testing::Not(HasSubstr("splat_foam"))) << "none is asked for";
    const auto white = pictures(block, 1.0F);
    EXPECT_THAT(passes(), HasSubstr("splat_foam"));
    EXPECT_EQ(white[0], clear[0]) << "nothing has moved yet";
    EXPECT_NE(white[4], clear[4]);

    // Particles that begin anew have none of the foam of those before them, though as much time has gone by.
    start(block);
    const auto first = draw(1, 4 * kFrame, 1.0F);
    auto anew = sized<SluiceStart>();
    anew.particle_count = block.simulation.particle_count;
    anew.position = block.simulation.position;
    std::vector<float> fast(3 * std::size_t{anew.particle_count});
    for (std::size_t i = 0; i < fast.size(); ++i) {
        fast[i] = i % 2 == 0 ? 0.5F : -0.5F;
    }
    anew.velocity = fast.data();
    EXPECT_EQ(api().reset_simulation(renderer->get(), &anew, &said), SLUICE_OK) << said.message;
    EXPECT_NE(draw(2, 4 * kFrame, 1.0F), first);
    anew.velocity = block.simulation.velocity;
    EXPECT_EQ(api().reset_simulation(renderer->get(), &anew, &said), SLUICE_OK) << said.message;
    EXPECT_EQ(draw(3, 4 * kFrame, 1.0F), first);

    for (const float life : {-1.0F, std::nanf("")}) {
        block.simulation.foam_life = life;
        EXPECT_EQ(api().set_simulation(renderer->get(), &block.simulation, &said), SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(said.message, HasSubstr("foam_life"));
    }
    block.simulation.foam_life = 1.0F;
    block.simulation.foam_crest[0] = 3.0F;
    EXPECT_EQ(api().set_simulation(renderer->get(), &block.simulation, &said), SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(said.message, HasSubstr("3 to 0 is no range"));
}

TEST_F(LiveShape, OfARatioThatIsNoneAreRefused) {
    Block block;
    ASSERT_NO_FATAL_FAILURE(start(block));
    for (const float ratio : {0.5F, 11.0F, -1.0F, std::nanf("")}) {
        block.simulation.anisotropy = ratio;
        auto error = sized<SluiceError>();
        EXPECT_EQ(api().set_simulation(renderer->get(), &block.simulation, &error), SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(std::string(error.message), HasSubstr("anisotropy"));
    }
}

}  // namespace
}  // namespace sluice::vk::test
