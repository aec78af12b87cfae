// SPDX-License-Identifier: MIT
// What `sluice stress` can be asked for. No OpenGL and no Vulkan type: the program's command line includes this.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sluice::stress {

/// Who hands what to whom, and in which order. docs/cli.md has a sentence for each.
enum class Pattern : std::uint8_t {
    GlToVk,
    VkToGl,
    PingPong,
    Ring,
    FanOut,
    HostInTheMiddle,
    WaitBeforeSignal,
    ResizeStorm,
    CreateDestroyStorm
};
/// How a value crosses. Native and Binary are known by name only: they are refused with negotiation's reason.
enum class Backend : std::uint8_t { Bridged, Finish, Native, Binary };
enum class Resource : std::uint8_t { Colour, D32F, R32F, Buffer };
/// Who waits for OpenGL's fences: the host's own thread, a bridge thread, or another process.
enum class Topology : std::uint8_t { OneThread, BridgeThread, TwoProcesses };
enum class Fault : std::uint8_t { None, Drop, Delay, Duplicate, SkipWait, WrongValue, EarlyReuse, Swap, WrongLayout };

template <typename T>
struct Named {
    T value;
    std::string_view name;
};
inline constexpr std::array<Named<Pattern>, 9> kPatterns{{{Pattern::GlToVk, "gl-to-vk"},
                                                          {Pattern::VkToGl, "vk-to-gl"},
                                                          {Pattern::PingPong, "ping-pong"},
                                                          {Pattern::Ring, "ring"},
                                                          {Pattern::FanOut, "fan-out"},
                                                          {Pattern::HostInTheMiddle, "host-in-the-middle"},
                                                          {Pattern::WaitBeforeSignal, "wait-before-signal"},
                                                          {Pattern::ResizeStorm, "resize-storm"},
                                                          {Pattern::CreateDestroyStorm, "create-destroy-storm"}}};
inline constexpr std::array<Named<Backend>, 4> kBackends{{{Backend::Bridged, "bridged"},
                                                          {Backend::Finish, "finish"},
                                                          {Backend::Native, "native"},
                                                          {Backend::Binary, "binary"}}};
inline constexpr std::array<Named<Resource>, 4> kResources{
    {{Resource::Colour, "colour"}, {Resource::D32F, "D32F"}, {Resource::R32F, "R32F"}, {Resource::Buffer, "buffer"}}};
inline constexpr std::array<Named<Topology>, 3> kTopologies{{{Topology::OneThread, "one-thread"},
                                                             {Topology::BridgeThread, "bridge-thread"},
                                                             {Topology::TwoProcesses, "two-processes"}}};
inline constexpr std::array<Named<Fault>, 9> kFaults{{{Fault::None, "none"},
                                                      {Fault::Drop, "drop"},
                                                      {Fault::Delay, "delay"},
                                                      {Fault::Duplicate, "duplicate"},
                                                      {Fault::SkipWait, "skip-wait"},
                                                      {Fault::WrongValue, "wrong-value"},
                                                      {Fault::EarlyReuse, "early-reuse"},
                                                      {Fault::Swap, "swap"},
                                                      {Fault::WrongLayout, "wrong-layout"}}};

template <typename T, std::size_t N>
[[nodiscard]] constexpr std::string_view nameIn(const std::array<Named<T>, N>& names, T value) {
    for (const Named<T>& one : names) {
        if (one.value == value) {
            return one.name;
        }
    }
    return "?";
}
[[nodiscard]] constexpr std::string_view toString(Pattern value) {
    return nameIn(kPatterns, value);
}
[[nodiscard]] constexpr std::string_view toString(Backend value) {
    return nameIn(kBackends, value);
}
[[nodiscard]] constexpr std::string_view toString(Resource value) {
    return nameIn(kResources, value);
}
[[nodiscard]] constexpr std::string_view toString(Topology value) {
    return nameIn(kTopologies, value);
}
[[nodiscard]] constexpr std::string_view toString(Fault value) {
    return nameIn(kFaults, value);
}

/// The run "piglit": as many links of one chain, through each of colour image, depth image and buffer, as piglit's
/// vk_ping_pong makes through its buffer: 255 iterations of 128.
inline constexpr std::uint64_t kAlternations = std::uint64_t{255} * 128;

/// One cell of the matrix.
struct Combination {
    Pattern pattern = Pattern::PingPong;
    Backend backend = Backend::Bridged;
    Resource resource = Resource::Colour;
    Topology topology = Topology::BridgeThread;
    Fault fault = Fault::None;
    bool operator==(const Combination&) const = default;
};

/// An empty choice stands for "all".
struct Options {
    std::optional<Pattern> pattern;
    std::optional<Backend> backend;
    std::optional<Resource> resource;
    std::optional<Topology> topology;
    std::optional<Fault> fault = Fault::None;
    bool alternations = false;  ///< of the resources: all but R32F, see kAlternations
    std::uint64_t seed = 1;
    std::optional<std::uint64_t> handoffs;  ///< in all, shared out evenly over the combinations
    std::optional<double> seconds;          ///< likewise
    std::string log;                        ///< where to keep the ledger's log of the first failure
    bool json = false;
};

}  // namespace sluice::stress
