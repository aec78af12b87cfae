// SPDX-License-Identifier: MIT
// The C ABI, pinned. A failure here means that plugins built against the released header would break: append fields at
// the end of a struct and raise the minor version, or raise the major one.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "sluice/plugin.h"

extern "C" {
std::uint32_t sluice_c99_abi_version(void);
std::size_t sluice_c99_renderer_api_size(void);
std::size_t sluice_c99_frame_size(void);
std::size_t sluice_c99_create_info_size(void);
std::uint32_t sluice_c99_depth_role_bit(void);
SluiceResult sluice_c99_fill_error(SluiceError* error);
}

namespace {

// As laid out by the System V ABI of x86-64, which is the only one that is released.
#if defined(__x86_64__) && defined(__LP64__)
namespace layout {
static_assert(sizeof(SluiceError) == 520);
static_assert(sizeof(SluiceTraceEvent) == 64);
static_assert(sizeof(SluiceImageExport) == 40);
static_assert(sizeof(SluiceHostServices) == 56);
static_assert(sizeof(SluiceHostCapabilities) == 412);
static_assert(sizeof(SluiceRendererCapabilities) == 428);
static_assert(sizeof(SluiceCamera) == 152);
static_assert(sizeof(SluiceSky) == 76);
static_assert(sizeof(SluiceFluid) == 112);
static_assert(sizeof(SluiceParticles) == 48);
static_assert(sizeof(SluiceEnvironment) == 24);
static_assert(sizeof(SluiceSceneNeeds) == 140);
static_assert(sizeof(SluicePassStats) == 80);
static_assert(sizeof(SluiceFrameStats) == 2600);
static_assert(sizeof(SluiceCreateInfo) == 444);
static_assert(sizeof(SluiceRendererInfo) == 516);
static_assert(sizeof(SluiceRendererApi) == 208);
static_assert(offsetof(SluiceError, code) == 4);
static_assert(offsetof(SluiceError, message) == 8);
static_assert(offsetof(SluiceTraceEvent, kind) == 4);
static_assert(offsetof(SluiceTraceEvent, track) == 8);
static_assert(offsetof(SluiceTraceEvent, direction) == 12);
static_assert(offsetof(SluiceTraceEvent, begin_ns) == 16);
static_assert(offsetof(SluiceTraceEvent, duration_ns) == 24);
static_assert(offsetof(SluiceTraceEvent, frame) == 32);
static_assert(offsetof(SluiceTraceEvent, value) == 40);
static_assert(offsetof(SluiceTraceEvent, bytes) == 48);
static_assert(offsetof(SluiceTraceEvent, name) == 56);
static_assert(offsetof(SluiceImageExport, role) == 4);
static_assert(offsetof(SluiceImageExport, image_set) == 8);
static_assert(offsetof(SluiceImageExport, format) == 12);
static_assert(offsetof(SluiceImageExport, width) == 16);
static_assert(offsetof(SluiceImageExport, height) == 20);
static_assert(offsetof(SluiceImageExport, allocation_size) == 24);
static_assert(offsetof(SluiceImageExport, fd) == 32);
static_assert(offsetof(SluiceImageExport, dedicated) == 36);
static_assert(offsetof(SluiceHostServices, abi_version) == 4);
static_assert(offsetof(SluiceHostServices, user) == 8);
static_assert(offsetof(SluiceHostServices, log) == 16);
static_assert(offsetof(SluiceHostServices, trace) == 24);
static_assert(offsetof(SluiceHostServices, share_image) == 32);
static_assert(offsetof(SluiceHostServices, retire_image) == 40);
static_assert(offsetof(SluiceHostServices, canary) == 48);
static_assert(offsetof(SluiceHostCapabilities, device_uuid_count) == 4);
static_assert(offsetof(SluiceHostCapabilities, device_uuids) == 8);
static_assert(offsetof(SluiceHostCapabilities, driver_uuid) == 72);
static_assert(offsetof(SluiceHostCapabilities, has_memory_object) == 88);
static_assert(offsetof(SluiceHostCapabilities, has_memory_object_fd) == 92);
static_assert(offsetof(SluiceHostCapabilities, has_semaphore) == 96);
static_assert(offsetof(SluiceHostCapabilities, has_semaphore_fd) == 100);
static_assert(offsetof(SluiceHostCapabilities, has_timeline_semaphore) == 104);
static_assert(offsetof(SluiceHostCapabilities, has_sync) == 108);
static_assert(offsetof(SluiceHostCapabilities, has_framebuffer_object) == 112);
static_assert(offsetof(SluiceHostCapabilities, texture_formats) == 116);
static_assert(offsetof(SluiceHostCapabilities, attachment_formats) == 120);
static_assert(offsetof(SluiceHostCapabilities, vendor) == 124);
static_assert(offsetof(SluiceHostCapabilities, renderer) == 188);
static_assert(offsetof(SluiceHostCapabilities, version) == 316);
static_assert(offsetof(SluiceHostCapabilities, reserved) == 380);
static_assert(offsetof(SluiceRendererCapabilities, api_version) == 4);
static_assert(offsetof(SluiceRendererCapabilities, device_uuid) == 8);
static_assert(offsetof(SluiceRendererCapabilities, driver_uuid) == 24);
static_assert(offsetof(SluiceRendererCapabilities, has_external_memory_fd) == 40);
static_assert(offsetof(SluiceRendererCapabilities, has_timeline_semaphore) == 44);
static_assert(offsetof(SluiceRendererCapabilities, exports_timeline_fd) == 48);
static_assert(offsetof(SluiceRendererCapabilities, exports_binary_fd) == 52);
static_assert(offsetof(SluiceRendererCapabilities, queue_families) == 56);
static_assert(offsetof(SluiceRendererCapabilities, queues) == 60);
static_assert(offsetof(SluiceRendererCapabilities, exportable_formats) == 64);
static_assert(offsetof(SluiceRendererCapabilities, storage_formats) == 68);
static_assert(offsetof(SluiceRendererCapabilities, blendable_formats) == 72);
static_assert(offsetof(SluiceRendererCapabilities, device_name) == 76);
static_assert(offsetof(SluiceRendererCapabilities, driver_name) == 204);
static_assert(offsetof(SluiceRendererCapabilities, driver_info) == 268);
static_assert(offsetof(SluiceRendererCapabilities, reserved) == 396);
static_assert(offsetof(SluiceCamera, view) == 0);
static_assert(offsetof(SluiceCamera, projection) == 64);
static_assert(offsetof(SluiceCamera, near_plane) == 128);
static_assert(offsetof(SluiceCamera, far_plane) == 132);
static_assert(offsetof(SluiceCamera, reserved) == 136);
static_assert(offsetof(SluiceSky, zenith) == 0);
static_assert(offsetof(SluiceSky, horizon) == 12);
static_assert(offsetof(SluiceSky, ground) == 24);
static_assert(offsetof(SluiceSky, to_sun) == 36);
static_assert(offsetof(SluiceSky, sun_radiance) == 48);
static_assert(offsetof(SluiceSky, reserved) == 60);
static_assert(offsetof(SluiceFluid, absorption) == 0);
static_assert(offsetof(SluiceFluid, scatter_colour) == 12);
static_assert(offsetof(SluiceFluid, index_of_refraction) == 24);
static_assert(offsetof(SluiceFluid, specular_power) == 28);
static_assert(offsetof(SluiceFluid, splat_radius) == 32);
static_assert(offsetof(SluiceFluid, filter) == 36);
static_assert(offsetof(SluiceFluid, filter_iterations) == 40);
static_assert(offsetof(SluiceFluid, filter_range) == 44);
static_assert(offsetof(SluiceFluid, filter_clamp) == 48);
static_assert(offsetof(SluiceFluid, filter_sigma) == 52);
static_assert(offsetof(SluiceFluid, filter_max_pixels) == 56);
static_assert(offsetof(SluiceFluid, thickness_scale) == 60);
static_assert(offsetof(SluiceFluid, thickness_blur) == 64);
static_assert(offsetof(SluiceFluid, refraction) == 68);
static_assert(offsetof(SluiceFluid, reflection) == 72);
static_assert(offsetof(SluiceFluid, view) == 76);
static_assert(offsetof(SluiceFluid, ellipsoids) == 80);
static_assert(offsetof(SluiceFluid, foam) == 84);
static_assert(offsetof(SluiceFluid, reserved) == 88);
static_assert(offsetof(SluiceParticles, count) == 4);
static_assert(offsetof(SluiceParticles, radius) == 8);
static_assert(offsetof(SluiceParticles, position) == 16);
static_assert(offsetof(SluiceParticles, velocity) == 24);
static_assert(offsetof(SluiceParticles, colour) == 32 && offsetof(SluiceParticles, fluid) == 40);
static_assert(offsetof(SluiceEnvironment, width) == 4);
static_assert(offsetof(SluiceEnvironment, height) == 8);
static_assert(offsetof(SluiceEnvironment, pixels) == 16);
static_assert(offsetof(SluiceSceneNeeds, width) == 4);
static_assert(offsetof(SluiceSceneNeeds, height) == 8);
static_assert(offsetof(SluiceSceneNeeds, particle_count) == 12);
static_assert(offsetof(SluiceSceneNeeds, has_environment_map) == 16);
static_assert(offsetof(SluiceSceneNeeds, outputs) == 20);
static_assert(offsetof(SluiceSceneNeeds, fluid) == 24 && offsetof(SluiceSceneNeeds, other_look_count) == 136);
static_assert(offsetof(SluiceFrame, image_set) == 4);
static_assert(offsetof(SluiceFrame, frame) == 8);
static_assert(offsetof(SluiceFrame, wait_value) == 16);
static_assert(offsetof(SluiceFrame, signal_value) == 24);
static_assert(offsetof(SluiceFrame, outputs) == 32);
static_assert(offsetof(SluiceFrame, flags) == 36);
static_assert(offsetof(SluiceFrame, camera) == 40);
static_assert(offsetof(SluiceFrame, sky) == 192);
static_assert(offsetof(SluiceFrame, fluid) == 268);
static_assert(offsetof(SluiceFrame, simulation) == 384 && offsetof(SluiceFrame, other_look_count) == 392);
static_assert(offsetof(SluiceFrame, other_looks) == 396 && sizeof(SluiceFrame) == 624 && sizeof(SluiceLook) == 32);
static_assert(sizeof(SluiceSolid) == 64, "it stands in arrays");
static_assert(offsetof(SluiceSimulation, gravity) == 36 && offsetof(SluiceSimulation, longest_step) == 72);
static_assert(offsetof(SluiceSimulation, solids) == 88 && offsetof(SluiceSimulation, tension) == 112);
static_assert(offsetof(SluiceSimulation, emitters) == 144 && offsetof(SluiceSimulation, mesh_indices) == 200);
static_assert(offsetof(SluiceSimulation, density_kernel) == 236);
static_assert(offsetof(SluiceSimulation, anisotropy) == 224 && offsetof(SluiceSimulation, depth_scale) == 240);
static_assert(offsetof(SluiceSimulation, foam_life) == 256 && offsetof(SluiceSimulation, fluids) == 288);
static_assert(sizeof(SluiceSimulation) == 312);
static_assert(sizeof(SluiceEmitter) == 80 && sizeof(SluiceDrain) == 48 && sizeof(SluiceForceField) == 64);
static_assert(offsetof(SluiceEmitter, fluid) == 52 && sizeof(SluiceFluidKind) == 32);
static_assert(sizeof(SluiceBody) == 96 && sizeof(SluicePathPoint) == 32 && sizeof(SluiceMesh) == 32);
static_assert(sizeof(SluiceBodyState) == 96 && offsetof(SluiceBodies, bodies) == 16);
static_assert(sizeof(SluiceBodyTarget) == 32);
static_assert(offsetof(SluiceFlow, emitters) == 40 && offsetof(SluiceFlow, fluid_count) == 1320);
static_assert(sizeof(SluiceFlow) == 1580);
static_assert(offsetof(SluiceStart, position) == 8 && offsetof(SluiceStart, particle_fluids) == 24);
static_assert(offsetof(SluiceSimulationStats, busy_ns) == 48 && offsetof(SluiceSimulationStats, message) == 84);
static_assert(sizeof(SluiceSimulationStats) == 592);
static_assert(offsetof(SluicePassStats, name) == 0);
static_assert(offsetof(SluicePassStats, nanoseconds) == 32);
static_assert(offsetof(SluicePassStats, elements) == 40);
static_assert(offsetof(SluicePassStats, bytes) == 48);
static_assert(offsetof(SluicePassStats, is_particles) == 56);
static_assert(offsetof(SluicePassStats, dispatches) == 60);
static_assert(offsetof(SluicePassStats, reserved) == 64);
static_assert(offsetof(SluiceFrameStats, pass_count) == 4);
static_assert(offsetof(SluiceFrameStats, frame) == 8);
static_assert(offsetof(SluiceFrameStats, passes) == 16);
static_assert(offsetof(SluiceFrameStats, cpu_copy_bytes) == 2576);
static_assert(offsetof(SluiceFrameStats, upload_bytes) == 2584);
static_assert(offsetof(SluiceFrameStats, validation_messages) == 2592);
static_assert(offsetof(SluiceCreateInfo, width) == 4);
static_assert(offsetof(SluiceCreateInfo, height) == 8);
static_assert(offsetof(SluiceCreateInfo, image_sets) == 12);
static_assert(offsetof(SluiceCreateInfo, timeline) == 16);
static_assert(offsetof(SluiceCreateInfo, validation) == 20);
static_assert(offsetof(SluiceCreateInfo, outputs) == 24);
static_assert(offsetof(SluiceCreateInfo, host_depth_format) == 28);
static_assert(offsetof(SluiceCreateInfo, host) == 32);
static_assert(offsetof(SluiceRendererInfo, timeline) == 4);
static_assert(offsetof(SluiceRendererInfo, formats) == 8);
static_assert(offsetof(SluiceRendererInfo, host_depth_encoding) == 72);
static_assert(offsetof(SluiceRendererInfo, image_sets) == 76);
static_assert(offsetof(SluiceRendererInfo, width) == 80);
static_assert(offsetof(SluiceRendererInfo, height) == 84);
static_assert(offsetof(SluiceRendererInfo, capabilities) == 88);
static_assert(offsetof(SluiceRendererApi, abi_version) == 4);
static_assert(offsetof(SluiceRendererApi, name) == 8);
static_assert(offsetof(SluiceRendererApi, version) == 16);
static_assert(offsetof(SluiceRendererApi, describe) == 24);
static_assert(offsetof(SluiceRendererApi, explain) == 32);
static_assert(offsetof(SluiceRendererApi, create) == 40);
static_assert(offsetof(SluiceRendererApi, info) == 48);
static_assert(offsetof(SluiceRendererApi, resize) == 56);
static_assert(offsetof(SluiceRendererApi, set_particles) == 64);
static_assert(offsetof(SluiceRendererApi, set_environment) == 72);
static_assert(offsetof(SluiceRendererApi, submit_frame) == 80);
static_assert(offsetof(SluiceRendererApi, poll) == 88);
static_assert(offsetof(SluiceRendererApi, timeline_signal) == 96);
static_assert(offsetof(SluiceRendererApi, timeline_wait) == 104);
static_assert(offsetof(SluiceRendererApi, timeline_value) == 112);
static_assert(offsetof(SluiceRendererApi, timeline_export) == 120);
static_assert(offsetof(SluiceRendererApi, probe_format) == 128);
static_assert(offsetof(SluiceRendererApi, destroy) == 136);
static_assert(offsetof(SluiceRendererApi, set_simulation) == 144);
static_assert(offsetof(SluiceRendererApi, simulate) == 152);
static_assert(offsetof(SluiceRendererApi, simulation_wait) == 160);
static_assert(offsetof(SluiceRendererApi, simulation_stats) == 168);
static_assert(offsetof(SluiceRendererApi, simulation_bodies) == 176);
static_assert(offsetof(SluiceRendererApi, set_body) == 184);
static_assert(offsetof(SluiceRendererApi, set_flow) == 192 && offsetof(SluiceRendererApi, reset_simulation) == 200);
}  // namespace layout
#endif

// Every struct that crosses by pointer says its size first.
template <typename Struct>
constexpr bool kSizePrefixed = std::is_standard_layout_v<Struct>&& offsetof(Struct, struct_size) == 0 &&
                               sizeof(Struct::struct_size) == 4;
static_assert(kSizePrefixed<SluiceError> && kSizePrefixed<SluiceTraceEvent> && kSizePrefixed<SluiceImageExport>);
static_assert(kSizePrefixed<SluiceHostServices> && kSizePrefixed<SluiceHostCapabilities>);
static_assert(kSizePrefixed<SluiceRendererCapabilities> && kSizePrefixed<SluiceParticles>);
static_assert(kSizePrefixed<SluiceEnvironment> && kSizePrefixed<SluiceSceneNeeds> && kSizePrefixed<SluiceFrame>);
static_assert(kSizePrefixed<SluiceFrameStats> && kSizePrefixed<SluiceCreateInfo> && kSizePrefixed<SluiceRendererInfo>);
static_assert(kSizePrefixed<SluiceRendererApi> && kSizePrefixed<SluiceSimulation>);
static_assert(kSizePrefixed<SluiceSimulationStats> && kSizePrefixed<SluiceBodies>);
static_assert(kSizePrefixed<SluiceBodyTarget> && kSizePrefixed<SluiceFlow> && kSizePrefixed<SluiceStart>);

TEST(PluginAbi, EnumerationsKeepTheirValues) {
    EXPECT_EQ(SLUICE_ABI_VERSION, 0x10003U);
    EXPECT_EQ(SLUICE_MAKE_ABI(2U, 3U), 0x20003U);
    EXPECT_EQ(SLUICE_FORMAT_D24S8, 13);
    EXPECT_EQ(SLUICE_FORMAT_COUNT, 14);
    EXPECT_LE(static_cast<int>(SLUICE_FORMAT_COUNT), 32) << "masks have one bit per format";
    EXPECT_EQ(SLUICE_IMAGE_CANARY, 6);
    EXPECT_EQ(SLUICE_IMAGE_ROLE_COUNT, 7);
    EXPECT_EQ(SLUICE_TIMELINE_UNSYNCHRONISED, 5);
    EXPECT_EQ(SLUICE_TRACE_MARK, 7);
    EXPECT_EQ(SLUICE_TRACK_RENDERER_QUEUE, 4);
    EXPECT_EQ(SLUICE_TRACK_SIMULATION, 5);
    EXPECT_EQ(SLUICE_SOLID_BOX, 3);
    EXPECT_EQ(SLUICE_VIEW_ECHO, 4);
    EXPECT_EQ(SLUICE_ERROR_INTERNAL, -9);
    EXPECT_EQ(SLUICE_TIMEOUT, 2);
    EXPECT_EQ(sizeof(SluiceResult), 4U);
}

TEST(PluginAbi, CAndCppSeeTheSameStructs) {
    EXPECT_EQ(sluice_c99_abi_version(), SLUICE_ABI_VERSION);
    EXPECT_EQ(sluice_c99_renderer_api_size(), sizeof(SluiceRendererApi));
    EXPECT_EQ(sluice_c99_frame_size(), sizeof(SluiceFrame));
    EXPECT_EQ(sluice_c99_create_info_size(), sizeof(SluiceCreateInfo));
    EXPECT_EQ(sluice_c99_depth_role_bit(), SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_DEPTH));
    SluiceError error{};
    EXPECT_EQ(sluice_c99_fill_error(&error), SLUICE_ERROR_UNSUPPORTED);
    EXPECT_EQ(error.struct_size, sizeof error);
    EXPECT_STREQ(error.message, "C");
}

}  // namespace
