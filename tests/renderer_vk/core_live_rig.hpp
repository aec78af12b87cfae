// SPDX-License-Identifier: MIT
// A renderer in whose inside a small fluid flows, and the same fluid by the solver alone.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core_fake_host.hpp"
#include "device/one_shot.hpp"
#include "memory/buffer.hpp"
#include "plugin/renderer.hpp"
#include "simulation/solver.hpp"

namespace sluice::vk::test {

inline constexpr std::uint64_t kLong = 60'000'000'000;
inline constexpr double kFrame = 1.0 / 60.0;

/// A block of 6 x 8 x 6 particles that falls into its box, 2 m in front of the camera of frameOf.
struct Block {
    explicit Block(std::uint32_t frames_in_flight = 1) {
        for (int i = 0; i < 6 * 8 * 6; ++i) {
            position.push_back(-0.18F + 0.06F * static_cast<float>(i % 6));
            position.push_back(-0.3F + 0.06F * static_cast<float>(i / 6 % 8));
            const int layer = i / 48;
            position.push_back(-2.18F + 0.06F * static_cast<float>(layer));
        }
        simulation = sized<SluiceSimulation>();
        simulation.frames_in_flight = frames_in_flight;
        simulation.radius = settings.radius = 0.03F;
        settings.low = {-0.5F, -0.5F, -2.5F};
        settings.high = {0.5F, 1.0F, -1.5F};
        settings.solids = {sphereSolid({0.0F, -0.45F, -2.0F}, 0.1F)};
        std::copy(settings.low.begin(), settings.low.end(), &simulation.low[0]);
        std::copy(settings.high.begin(), settings.high.end(), &simulation.high[0]);
        std::copy(settings.gravity.begin(), settings.gravity.end(), &simulation.gravity[0]);
        simulation.iterations = settings.iterations;
        simulation.relaxation = settings.relaxation;
        simulation.tensile = settings.tensile;
        simulation.viscosity = settings.viscosity;
        simulation.cfl = settings.cfl;
        simulation.longest_step = 1.0 / 120.0;
        solid.kind = SLUICE_SOLID_SPHERE;
        solid.a[1] = -0.45F;
        solid.a[2] = -2.0F;
        solid.radius = 0.1F;
        simulation.solids = &solid;
        simulation.solid_count = 1;
        simulation.particle_count = static_cast<std::uint32_t>(position.size() / 3);
        simulation.position = position.data();
    }
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;

    SimulationSettings settings;
    SluiceSolid solid{};
    std::vector<float> position;
    std::vector<float> velocity;       ///< of alone(); none: at rest
    std::vector<std::uint32_t> fluid;  ///< of each particle, where there are several
    SluiceSimulation simulation{};
    std::function<void(Solver&)> seen;  ///< of alone()
};

/// The fluid of `settings` by the solver alone, value by value; `seen` looks at the solver after each.
inline std::vector<ParticleState> alone(const SimulationSettings& settings, const std::vector<float>& position,
                                        double longest, std::uint64_t values,
                                        const std::function<void(Solver&)>& seen = {},
                                        const std::vector<float>& velocity = {},
                                        const std::vector<std::uint32_t>& fluid = {}) {
    std::vector<ParticleState> states;
    DeviceRequest request;
    request.match_host = false;
    auto device = Device::create(request);
    auto solver = Solver::create(*device.value(), settings);
    EXPECT_TRUE(solver) << solver.error().message();
    EXPECT_TRUE(solver.value()->setParticles(position, velocity, fluid));
    for (std::uint64_t value = 1; value <= values; ++value) {
        if (value > 1) {
            EXPECT_TRUE(solver.value()->advance(kFrame, longest));
        }
        states.push_back(solver.value()->read().value());
        if (seen) {
            seen(*solver.value());
        }
    }
    return states;
}

class LiveFluid : public ::testing::Test {
  protected:
    void start(const Block& block, bool tracing = false, bool validation = true) {
        renderer.reset();
        host = std::make_unique<FakeHost>(tracing);
        host->keep_descriptors = true;
        host->fail_canary_formats = without_formats;
        SluiceCreateInfo info = host->createInfo();
        info.validation = validation ? 1 : 0;
        renderer = std::make_unique<TestRenderer>(*host, info);
        ASSERT_EQ(renderer->result(), SLUICE_OK) << renderer->error().message;
        auto error = sized<SluiceError>();
        ASSERT_EQ(api().set_simulation(renderer->get(), &block.simulation, &error), SLUICE_OK) << error.message;
    }
    SluiceResult simulate(std::uint64_t value, double seconds) {
        said = sized<SluiceError>();
        return api().simulate(renderer->get(), value, seconds, &said);
    }
    /// Frame k with the fluid of `value`, and its colours.
    std::vector<std::byte> draw(std::uint64_t k, std::uint64_t value, std::uint32_t flags = 0) {
        SluiceFrame frame = frameOf(k, 2, SLUICE_VIEW_FLUID);
        frame.simulation = value;
        frame.flags = flags;
        std::fill_n(&frame.fluid.scatter_colour[0], 3, scatter);
        frame.other_look_count = static_cast<std::uint32_t>(others.size());
        std::copy(others.begin(), others.end(), &frame.other_looks[0]);
        EXPECT_EQ(renderer->submit(frame), SLUICE_OK) << renderer->error().message;
        EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value), SLUICE_OK);
        EXPECT_EQ(api().timeline_wait(renderer->get(), k, kLong), SLUICE_OK);
        EXPECT_EQ(api().timeline_signal(renderer->get(), frame.wait_value + 1), SLUICE_OK);
        return host->texels(SLUICE_IMAGE_FLUID_COLOUR, frame.image_set);
    }
    /// The pictures of the first values of `block` by the solver alone, given to the renderer as a host would.
    std::vector<std::vector<std::byte>> uploaded(const Block& block, std::uint64_t values) {
        std::vector<std::vector<std::byte>> pictures;
        for (const ParticleState& state : alone(block.settings, block.position, block.simulation.longest_step, values,
                                                block.seen, block.velocity, block.fluid)) {
            auto particles = sized<SluiceParticles>();
            particles.count = static_cast<std::uint32_t>(state.position.size() / 3);
            particles.radius = block.simulation.radius;
            particles.position = state.position.data();
            particles.fluid = state.fluid.empty() ? nullptr : state.fluid.data();
            EXPECT_EQ(api().set_particles(renderer->get(), &particles, nullptr), SLUICE_OK);
            pictures.push_back(draw(pictures.size() + 1, 0));
        }
        return pictures;
    }
    /// Of a value that a frame has drawn and whose slot is not asked for again.
    std::vector<float> positions(std::uint64_t value) {
        const Device& device = renderer->get()->device();
        const ParticleBuffers from = renderer->get()->simulation()->slots().buffers(value);
        std::vector<float> out(std::size_t{3} * stats().particle_count);
        const VkDeviceSize bytes = out.size() * sizeof(float);
        auto to = Buffer::create(device, {bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback, "positions"});
        EXPECT_TRUE(to) << to.error().message();
        const VkBufferCopy all{0, 0, bytes};
        EXPECT_TRUE(runOnce(device, [&](VkCommandBuffer commands) {
            device.fn.vkCmdCopyBuffer(commands, from.position, to.value().buffer(), 1, &all);
        }));
        std::memcpy(out.data(), to.value().mapped().data(), bytes);
        return out;
    }
    /// The first values live, with so many in flight, against the pictures of the solver alone.
    void expectPictures(const Block& block, const std::vector<std::vector<std::byte>>& pictures) {
        ASSERT_NO_FATAL_FAILURE(start(block));
        const std::uint32_t in_flight = block.simulation.frames_in_flight;
        std::uint64_t asked = 0;
        for (std::uint64_t k = 1; k <= pictures.size(); ++k) {
            for (; asked < std::min<std::uint64_t>(pictures.size(), k + in_flight - 1); ++asked) {
                ASSERT_EQ(simulate(asked + 1, asked == 0 ? 0.0 : kFrame), SLUICE_OK) << said.message;
            }
            EXPECT_EQ(draw(k, k), pictures[k - 1]) << "value " << k << ", " << in_flight << " frames in flight";
        }
        EXPECT_EQ(stats().failed, 0U) << stats().message;
        EXPECT_EQ(frameStats(pictures.size()).validation_messages, 0U);
    }
    SluiceSimulationStats stats() {
        auto out = sized<SluiceSimulationStats>();
        EXPECT_EQ(api().simulation_stats(renderer->get(), &out), SLUICE_OK);
        return out;
    }
    SluiceFrameStats frameStats(std::uint64_t k) {
        auto out = sized<SluiceFrameStats>();
        EXPECT_EQ(api().poll(renderer->get(), k, &out), SLUICE_OK);
        return out;
    }
    std::size_t logged(const std::string& text) const {
        const auto lines = host->log();
        return static_cast<std::size_t>(std::count_if(
            lines.begin(), lines.end(), [&](const std::string& line) { return line.find(text) != std::string::npos; }));
    }

    std::uint32_t without_formats = 0;  ///< bits of formats that the host of start() does not have
    std::vector<SluiceLook> others;     ///< of every frame
    float scatter = 0.0F;               ///< likewise; the host's frame is black, so that nothing comes through
    SluiceBodies scratch = sized<SluiceBodies>();
    std::unique_ptr<FakeHost> host;
    std::unique_ptr<TestRenderer> renderer;
    SluiceError said{};
};

}  // namespace sluice::vk::test
