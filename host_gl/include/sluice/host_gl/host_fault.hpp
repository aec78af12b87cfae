// SPDX-License-Identifier: MIT
// One misfortune of a renderer or of the machine under it, made on purpose: what FluidHost does about it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace sluice::host {

/// The plugin itself is not touched: the host acts as if it had answered so. OutOfFds alone takes the thing away.
enum class HostFaultKind : std::uint8_t {
    DeviceLost,   ///< submit_frame says that the device is lost; value: tries for another renderer that fail, too
    PluginError,  ///< submit_frame fails for no good reason; value: frames in a row, 0 means 1
    Hang,         ///< submit_frame does not return for so many milliseconds; 0 means 3000
    OutOfFds,     ///< the device is lost, and for so many tries no descriptor is to be had; 0 means 1
    OutOfMemory,  ///< the device is lost, and so many tries find no memory; 0 means 1
    ContextLost,  ///< the GL context has been reset
};
inline constexpr std::array<std::pair<std::string_view, HostFaultKind>, 6> kHostFaultNames{
    {{"device-lost", HostFaultKind::DeviceLost},
     {"plugin-error", HostFaultKind::PluginError},
     {"hang", HostFaultKind::Hang},
     {"out-of-fds", HostFaultKind::OutOfFds},
     {"out-of-memory", HostFaultKind::OutOfMemory},
     {"context-lost", HostFaultKind::ContextLost}}};

inline constexpr std::uint64_t kHangMs = 3000;

struct HostFault {
    HostFaultKind kind{};
    std::uint64_t frame = 0;  ///< calls of FluidHost::submit, from 1
    std::uint64_t value = 0;  ///< see HostFaultKind
};

}  // namespace sluice::host
