// SPDX-License-Identifier: MIT
// What the two processes of an isolated renderer say to each other: the calls of sluice/plugin.h as bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::isolate {

/// Longest message, header included. Arrays without such a bound (particles, environment maps) cross as memory.
inline constexpr std::size_t kMaxMessage = 16384;
/// Longest text in a message; what is longer is cut by the sender and refused by the receiver.
inline constexpr std::size_t kMaxText = 2048;
inline constexpr std::size_t kMaxTraceEvents = 48;

/// Each struct below is one kind of message. `fields` lists what crosses, for the writer and the reader alike; kFdsMin
/// and kFdsMax say how many descriptors come with it.
template <std::uint32_t Min, std::uint32_t Max>
struct Carries {
    static constexpr std::uint32_t kFdsMin = Min;
    static constexpr std::uint32_t kFdsMax = Max;
};

// ---- host to renderer. Each is answered with Returned; Hello with Welcome.

/// Comes first, with the memory of the timeline. For tests the host may ask the process to die at a frame.
struct Hello : Carries<1, 1> {
    static constexpr std::string_view kName = "hello";
    std::uint32_t abi_version = 0;
    std::uint32_t fault_signal = 0;     ///< 0: none
    std::uint32_t fault_in_submit = 0;  ///< 1: once submit_frame has submitted; 0: when the frame's value is to be told
    std::uint64_t fault_frame = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.abi_version);
        io.number(m.fault_signal);
        io.number(m.fault_in_submit);
        io.number(m.fault_frame);
    }
};
struct Describe : Carries<0, 0> {
    static constexpr std::string_view kName = "describe";
    std::uint32_t wants_trace = 0;
    SluiceCreateInfo info{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.wants_trace);
        io.abi(m.info);
    }
};
struct Explain : Carries<0, 0> {
    static constexpr std::string_view kName = "explain";
    SluiceSceneNeeds needs{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.abi(m.needs);
    }
};
struct Create : Carries<0, 0> {
    static constexpr std::string_view kName = "create";
    std::uint32_t wants_trace = 0;
    SluiceCreateInfo info{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.wants_trace);
        io.abi(m.info);
    }
};
struct Info : Carries<0, 0> {
    static constexpr std::string_view kName = "info";
    template <typename Io, typename Self>
    static void fields(Io& /*io*/, Self& /*m*/) {}
};
struct Resize : Carries<0, 0> {
    static constexpr std::string_view kName = "resize";
    std::uint32_t width = 0, height = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.width);
        io.number(m.height);
    }
};
/// The arrays follow each other in the memory that comes with it: positions, then velocities, then colours.
struct SetParticles : Carries<0, 1> {
    static constexpr std::string_view kName = "set_particles";
    std::uint32_t count = 0;
    float radius = 0.0F;
    std::uint32_t has_velocity = 0, has_colour = 0, has_fluid = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.count);
        io.number(m.radius);
        io.number(m.has_velocity);
        io.number(m.has_colour);
        io.number(m.has_fluid);
    }
};
struct SetEnvironment : Carries<0, 1> {
    static constexpr std::string_view kName = "set_environment";
    std::uint32_t width = 0, height = 0;  ///< without memory: the procedural sky
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.width);
        io.number(m.height);
    }
};
struct SubmitFrame : Carries<0, 0> {
    static constexpr std::string_view kName = "submit_frame";
    SluiceFrame frame{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.abi(m.frame);
    }
};
struct Poll : Carries<0, 0> {
    static constexpr std::string_view kName = "poll";
    std::uint64_t frame = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.frame);
    }
};
/// For the timelines that OpenGL signals; the others are read in the shared memory.
struct TimelineValue : Carries<0, 0> {
    static constexpr std::string_view kName = "timeline_value";
    std::uint32_t direction = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.direction);
    }
};
struct TimelineExport : Carries<0, 0> {
    static constexpr std::string_view kName = "timeline_export";
    std::uint32_t direction = 0;
    std::uint64_t value = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.direction);
        io.number(m.value);
    }
};
struct ProbeFormat : Carries<0, 0> {
    static constexpr std::string_view kName = "probe_format";
    std::uint32_t wants_trace = 0, format = 0, width = 0, height = 0;
    SluiceCreateInfo info{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.wants_trace);
        io.number(m.format);
        io.number(m.width);
        io.number(m.height);
        io.abi(m.info);
    }
};
struct Destroy : Carries<0, 0> {
    static constexpr std::string_view kName = "destroy";
    template <typename Io, typename Self>
    static void fields(Io& /*io*/, Self& /*m*/) {}
};

/// Without memory: the simulation ends. With it: the arrays in the order of eachArray (sluice/simulation_arrays.hpp).
struct SetSimulation : Carries<0, 1> {
    static constexpr std::string_view kName = "set_simulation";
    std::uint32_t has_velocity = 0;
    SluiceSimulation simulation{};  ///< its pointers say nothing here
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.has_velocity);
        io.abi(m.simulation);
    }
};
struct Simulate : Carries<0, 0> {
    static constexpr std::string_view kName = "simulate";
    std::uint64_t value = 0;
    double seconds = 0.0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.value);
        io.number(m.seconds);
    }
};
/// simulation_wait is this, asked again and again: a call that waits would hold up all others.
struct SimulationStats : Carries<0, 0> {
    static constexpr std::string_view kName = "simulation_stats";
    template <typename Io, typename Self>
    static void fields(Io& /*io*/, Self& /*m*/) {}
};

struct SimulationBodies : Carries<0, 0> {
    static constexpr std::string_view kName = "simulation_bodies";
    std::uint64_t value = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.value);
    }
};
struct SetBody : Carries<0, 0> {
    static constexpr std::string_view kName = "set_body";
    std::uint32_t body = 0;
    SluiceBodyTarget target{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.body);
        io.abi(m.target);
    }
};

struct SetFlow : Carries<0, 0> {
    static constexpr std::string_view kName = "set_flow";
    SluiceFlow flow{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.abi(m.flow);
    }
};

/// Positions, then velocities, in the memory that comes with it; none without particles.
struct ResetSimulation : Carries<0, 1> {
    static constexpr std::string_view kName = "reset_simulation";
    std::uint32_t has_velocity = 0, has_fluids = 0;
    SluiceStart start{};  ///< its pointers say nothing here
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.has_velocity);
        io.number(m.has_fluids);
        io.abi(m.start);
    }
};

// ---- renderer to host.

/// The answer to Hello: what the plugin is.
struct Welcome : Carries<0, 0> {
    static constexpr std::string_view kName = "welcome";
    std::uint32_t abi_version = 0;
    std::string name, version;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.abi_version);
        io.text(m.name);
        io.text(m.version);
    }
};
/// The end of a call. With timeline_export that succeeded comes a descriptor.
struct Returned : Carries<0, 1> {
    static constexpr std::string_view kName = "returned";
    std::int32_t result = 0;  ///< SluiceResult
    std::uint64_t value = 0;
    std::string message;
    std::variant<std::monostate, SluiceRendererCapabilities, SluiceRendererInfo, SluiceFrameStats,
                 SluiceSimulationStats, SluiceBodies>
        filled;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.result(m.result);
        io.number(m.value);
        io.text(m.message);
        io.filled(m.filled);
    }
};
struct Log : Carries<0, 0> {
    static constexpr std::string_view kName = "log";
    std::int32_t level = 0;
    std::string text;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.level);
        io.text(m.text);
    }
};
/// A SluiceTraceEvent; its name by value.
struct TracePoint {
    std::uint32_t kind = 0, track = 0, direction = 0;
    std::uint64_t begin_ns = 0, duration_ns = 0, frame = 0, value = 0, bytes = 0;
    std::array<char, 32> name{};
};
struct TraceEvents : Carries<0, 0> {
    static constexpr std::string_view kName = "trace";
    std::vector<TracePoint> events;  ///< kMaxTraceEvents at most
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.list(m.events, kMaxTraceEvents, [](auto& each, auto& event) {
            each.number(event.kind);
            each.number(event.track);
            each.number(event.direction);
            each.number(event.begin_ns);
            each.number(event.duration_ns);
            each.number(event.frame);
            each.number(event.value);
            each.number(event.bytes);
            each.name(event.name);
        });
    }
};
/// One line of an explanation.
struct Line : Carries<0, 0> {
    static constexpr std::string_view kName = "line";
    std::string text;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.text(m.text);
    }
};

// ---- renderer to host while a call is pending; each is answered with Answer.

/// The descriptor is the image's memory; SluiceImageExport::fd itself says nothing here.
struct ShareImage : Carries<1, 1> {
    static constexpr std::string_view kName = "share_image";
    SluiceImageExport image{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.abi(m.image);
    }
};
struct RetireImage : Carries<0, 0> {
    static constexpr std::string_view kName = "retire_image";
    std::uint32_t role = 0, image_set = 0;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.role);
        io.number(m.image_set);
    }
};
struct Canary : Carries<1, 1> {
    static constexpr std::string_view kName = "canary";
    std::uint32_t seed = 0;
    SluiceImageExport image{};
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.number(m.seed);
        io.abi(m.image);
    }
};
struct Answer : Carries<0, 0> {
    static constexpr std::string_view kName = "answer";
    std::int32_t result = 0;  ///< SluiceResult
    std::string message;
    template <typename Io, typename Self>
    static void fields(Io& io, Self& m) {
        io.result(m.result);
        io.text(m.message);
    }
};

/// The number of a kind on the wire is its place here, so kinds are only ever appended.
using Message = std::variant<Hello, Describe, Explain, Create, Info, Resize, SetParticles, SetEnvironment, SubmitFrame,
                             Poll, TimelineValue, TimelineExport, ProbeFormat, Destroy, Welcome, Returned, Log,
                             TraceEvents, Line, ShareImage, RetireImage, Canary, Answer, SetSimulation, Simulate,
                             SimulationStats, SimulationBodies, SetBody, SetFlow, ResetSimulation>;

[[nodiscard]] std::string_view nameOf(const Message& message);

struct Decoded {
    std::uint64_t call = 0;  ///< which call it belongs to; 0: none
    Message message;
};

/// The bytes of one message that will carry `fds` descriptors. Texts and lists are cut to what a receiver accepts.
[[nodiscard]] std::vector<std::byte> encode(const Message& message, std::uint64_t call, std::uint32_t fds);
/// Trusts nothing: magic, version, kind, lengths, counts and every field are checked, texts end where they say, and
/// nothing may follow. The error names the kind, the offset, what was expected and what was found.
[[nodiscard]] Result<Decoded> decode(std::span<const std::byte> bytes, std::uint32_t fds);

}  // namespace sluice::isolate
