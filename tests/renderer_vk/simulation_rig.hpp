// SPDX-License-Identifier: MIT
// Particles to simulate, and a device to do it on.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "device/commands.hpp"
#include "device/device.hpp"
#include "device/one_shot.hpp"
#include "memory/buffer.hpp"
#include "simulation/solver.hpp"
#include "simulation/vector.hpp"

namespace sluice::vk::test {

/// One device per test, with synchronisation validation, which must stay silent.
class SimulationTest : public ::testing::Test {
  protected:
    void SetUp() override {
        DeviceRequest request;
        request.match_host = false;
        request.validation = true;
        auto device = Device::create(request);
        ASSERT_TRUE(device.ok()) << device.error().message();
        device_ = std::move(device).value();
    }
    void TearDown() override {
        if (device_) {
            EXPECT_EQ(device_->validationMessages(), 0U);
        }
    }
    [[nodiscard]] std::unique_ptr<Solver> make(const SimulationSettings& settings, const std::vector<float>& positions,
                                               const std::vector<float>& velocities = {}) const {
        auto solver = Solver::create(*device_, settings);
        EXPECT_TRUE(solver.ok()) << solver.error().message();
        const Status status = solver.value()->setParticles(positions, velocities);
        EXPECT_TRUE(status.ok()) << status.error().message();
        return std::move(solver).value();
    }
    [[nodiscard]] const Device& device() const { return *device_; }
    /// What `fill` leaves in a buffer of so many floats, which were all `before`.
    [[nodiscard]] std::vector<float> filled(std::size_t floats, float before,
                                            const std::function<Status(VkBuffer)>& fill) const {
        std::vector<float> out(floats, before);
        const VkDeviceSize bytes = floats * sizeof(float);
        Result<Buffer> buffer =
            Buffer::create(*device_, {bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                      BufferPlace::Upload, "what a test looks at"});
        EXPECT_TRUE(buffer.ok());
        std::memcpy(buffer.value().mapped().data(), out.data(), bytes);
        const Status status = fill(buffer.value().buffer());
        EXPECT_TRUE(status.ok()) << status.error().message();
        const Status seen = runOnce(*device_, [this](VkCommandBuffer commands) {
            memoryBarrier(*device_, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                          VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
        });
        EXPECT_TRUE(seen.ok());
        std::memcpy(out.data(), buffer.value().mapped().data(), bytes);
        return out;
    }

  private:
    std::unique_ptr<Device> device_;
};

/// Uniform numbers that are the same with every standard library.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() >> 8) / static_cast<float>(1U << 24);
    }

  private:
    std::mt19937 engine_;
};

/// x by y by z particles, `spacing` apart, each moved by up to `jitter` along every axis; the first is half a spacing
/// from `corner`.
inline std::vector<float> lattice(const Triple& corner, int x, int y, int z, float spacing, float jitter,
                                  std::uint32_t seed) {
    Dice dice(seed);
    std::vector<float> positions;
    for (int i = 0; i < x * y * z; ++i) {
        const int cell[3] = {i % x, i / x % y, i / x / y};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            positions.push_back(corner[axis] + spacing * (static_cast<float>(cell[axis]) + 0.5F) +
                                dice.between(-jitter, jitter));
        }
    }
    return positions;
}

/// Packed triples as vectors in doubles.
inline std::vector<Vector> vectorsOf(const std::vector<float>& triples) {
    std::vector<Vector> vectors(triples.size() / 3);
    for (std::size_t i = 0; i < triples.size(); ++i) {
        vectors[i / 3][i % 3] = double{triples[i]};
    }
    return vectors;
}

inline double apart(const Vector& a, const Vector& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

inline double squares(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0,
                           [](double total, float value) { return total + double{value} * double{value}; });
}

/// Potential and kinetic, of particles of mass 1 under the default gravity.
inline double energyOf(const ParticleState& state) {
    double potential = 0.0;
    for (std::size_t i = 1; i < state.position.size(); i += 3) {
        potential += 9.81 * double{state.position[i]};
    }
    return potential + 0.5 * squares(state.velocity);
}

}  // namespace sluice::vk::test
