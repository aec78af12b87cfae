// SPDX-License-Identifier: MIT
// A device, a recorder and images in the place of the host's: renders one frame and reads everything back.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "passes/fluid_recorder.hpp"

namespace sluice::vk::test {

/// Tuned on the coarse conforming set (normal error 3.26 pool, 1.01 ball, degrees). p100k.pos still looks grainy with
/// it: filter_sigma 1.2, filter_range 6, filter_clamp 1 is smoother there and scores 4.56, 0.85.
inline constexpr SluiceFluid kWater{
    .absorption = {1.8F, 0.45F, 0.25F},
    .scatter_colour = {0.005F, 0.035F, 0.045F},
    .index_of_refraction = 1.333F,
    .specular_power = 400.0F,
    .splat_radius = 1.5F,
    .filter = SLUICE_FILTER_NARROW_RANGE,
    .filter_iterations = 2,
    .filter_range = 5.0F,
    .filter_clamp = 2.0F,
    .filter_sigma = 0.8F,
    .filter_max_pixels = 48,
    .thickness_scale = 0.5F,
    .thickness_blur = 1.5F,
    .refraction = 1,
    .reflection = 1,
    .view = SLUICE_VIEW_FLUID,
    .ellipsoids = 0,
    .foam = 0.0F,
    .reserved = {},
};

/// Everything that a frame depends on. Host images are rows bottom-up; colour is sRGB-encoded RGBA8.
struct RigScene {
    std::uint32_t width = 64, height = 48;
    std::vector<float> positions;                  ///< triples
    std::vector<float> ellipsoids;                 ///< nine floats each, in place of positions; or empty
    float longest = 1.0F;                          ///< of their axes
    std::vector<std::uint32_t> fluids;             ///< of each particle; or empty
    std::vector<std::array<float, 3>> absorption;  ///< of the fluids after the first
    std::vector<float> foam;                       ///< of each particle, 0 to 1; or empty
    float radius = 0.05F;
    SluiceCamera camera{};
    SluiceSky sky{};
    SluiceFluid fluid = kWater;
    std::uint32_t outputs = 0;
    std::vector<std::uint8_t> host_colour;  ///< empty: mid grey
    std::vector<float> host_depth;          ///< empty: nothing drawn
    SluiceDepthEncoding encoding = SLUICE_DEPTH_WINDOW;
    std::vector<float> environment;  ///< RGB triples; empty: procedural sky
    std::uint32_t environment_width = 0, environment_height = 0;
    std::uint32_t capture_scale = 0;  ///< not 0: the host's depth is captured for a simulation
};

/// What came out. Vectors are empty where the plan has no such image.
struct RigResult {
    Plan plan;
    std::vector<std::array<float, 4>> colour, normal_out;
    std::vector<float> depth, thickness_out;    ///< FLUID_DEPTH, FLUID_THICKNESS
    std::vector<float> surface;                 ///< metres, final depth
    std::vector<float> depth_a;                 ///< metres; the splat if there is no filter
    std::vector<std::array<float, 4>> normal;   ///< decoded from half floats
    std::vector<float> thickness;               ///< metres, reduced resolution
    std::vector<std::array<float, 4>> optical;  ///< optical depth of several looks
    std::uint32_t thickness_width = 0, thickness_height = 0;
    std::vector<float> foam;                                   ///< metres, at the resolution of thickness
    std::vector<float> captured;                               ///< DepthHeader and depths
    std::vector<std::pair<std::string, double>> milliseconds;  ///< per pass, where the device has timestamps
    std::string failure;                                       ///< empty on success
};

/// One device for all tests of a program, with synchronisation validation.
class PassRig {
  public:
    PassRig();
    ~PassRig();
    PassRig(const PassRig&) = delete;
    PassRig& operator=(const PassRig&) = delete;

    [[nodiscard]] RigResult render(const RigScene& scene);
    [[nodiscard]] std::uint32_t validationMessages() const { return device_ ? device_->validationMessages() : 0; }
    [[nodiscard]] const std::string& failure() const { return failure_; }

  private:
    std::unique_ptr<Device> device_;
    std::unique_ptr<FluidRecorder> recorder_;
    std::string failure_;
};

/// OpenGL perspective with the given vertical field of view in radians; `shift` moves the picture's centre in NDC.
[[nodiscard]] SluiceCamera perspective(double fov_y, double aspect, float near, float far,
                                       std::array<double, 2> shift = {0, 0});
/// Puts the camera at `eye`, looking at `at`, +y up.
void lookAt(SluiceCamera& camera, std::array<double, 3> eye, std::array<double, 3> at);
/// A clear day.
[[nodiscard]] SluiceSky clearDay();

}  // namespace sluice::vk::test
