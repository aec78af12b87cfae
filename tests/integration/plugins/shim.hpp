// SPDX-License-Identifier: MIT
// What a test may ask of the shim renderer.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace sluice::host::test {

/// Functions of the table that a renderer instance has.
enum class Entry : std::uint8_t {
    None,
    Create,
    Info,
    Resize,
    SetParticles,
    SetEnvironment,
    SubmitFrame,
    Poll,
    TimelineSignal,
    TimelineWait,
    TimelineValue,
    TimelineExport
};
/// One thing about an image that is shared which is not so.
enum class ImageLie : std::uint8_t {
    None,
    Role,
    OtherRole,
    Set,
    Format,
    NoWidth,
    TwiceAsWide,
    NoMemory,
    Tiny,
    NotShared,
    // Of these OpenGL takes no notice.
    NotDedicated,
    Larger,
    LostDescriptor  ///< the host gets a duplicate, and nobody closes the renderer's own
};
/// One thing that the renderer says of itself which is not so.
enum class InfoLie : std::uint8_t { None, Timeline, Sets, Size, Format, Encoding, EndlessNames, Device, Driver };
/// One thing about the statistics of a frame.
enum class StatsLie : std::uint8_t { None, PassCount, EndlessNames };

constexpr const char* kShimControlSymbol = "sluice_shim_control";

inline constexpr std::uint64_t kAnyFrame = UINT64_MAX;

/// Everything zero: the real renderer, unchanged. The GL thread alone touches it.
struct ShimControl {
    std::uint32_t lies = 0;         ///< bit per SluiceTimelineKind: claimed without semaphores, bridged underneath
    std::uint32_t refuses = 0;      ///< bit per SluiceTimelineKind: create fails when it is asked for
    std::uint64_t lose_submit = 0;  ///< submit_frame of this frame, or of kAnyFrame, says that the device is lost
    std::uint64_t lose_poll = 0;    ///< poll of this frame says so
    std::uint64_t fail_from = 0, fail_to = 0;          ///< submit_frame of these frames fails inside the real renderer
    std::uint64_t stall_value = 0;                     ///< timeline_wait for this value does not see it ...
    std::uint64_t stall_ms = 0;                        ///< ... until so long after the first call
    std::uint64_t time_out_from = 0, time_out_to = 0;  ///< timeline_wait for these values says that time is up
    std::uint32_t fail_resizes = 0;            ///< so many calls of resize fail in the middle: there are no images
    std::uint32_t refuses_particles_of = 0;    ///< set_particles of so many is refused as too many
    std::uint32_t refuses_environment_of = 0;  ///< set_environment of a map so wide likewise
    float refuses_flow_of = 0.0F;              ///< set_flow with this in its gravity's first component likewise
    std::uint64_t hang_frame = 0;              ///< submit_frame of this frame returns when `release` says so
    std::atomic<bool> release{false};
    Entry broken{};        ///< this function fails, with a message that has no end
    ImageLie image_lie{};  ///< of every image
    InfoLie info_lie{};
    StatsLie stats_lie{};
    bool mute = false;                        ///< the renderer is not given the trace service
    bool drop_host_wait = false;              ///< timeline_wait returns at once
    std::uint32_t waits = 0;                  ///< calls of timeline_wait
    std::uint32_t submits = 0;                ///< calls of submit_frame
    std::uint32_t destroys = 0;               ///< calls of destroy with a renderer
    std::uint32_t particles = 0;              ///< count of the last set_particles
    float first_coordinate = 0.0F;            ///< its first coordinate
    std::uint32_t environment_width = 0;      ///< of the last set_environment
    float flow_gravity = 0.0F;                ///< its first component, of the last set_flow
    std::uint32_t attempt_count = 0;          ///< calls of create
    std::array<std::uint32_t, 8> attempts{};  ///< SluiceTimelineKind of each
    std::array<int, 32> lost{};               ///< of LostDescriptor, for the test to close
    std::uint32_t lost_count = 0;
};

}  // namespace sluice::host::test
