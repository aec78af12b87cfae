// SPDX-License-Identifier: MIT
// How structs of the plugin ABI cross between sides of different minor versions. Each struct has a smallest size, that
// of ABI 1.0; between that and the reader's own sizeof, what one side lacks is zero.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// The bytes of T that ABI 1.0, or the minor that brought T, has: up to the end of its last field then, without
/// padding. Never changed within a major, whatever is appended to T. T itself tells only for structs that a test
/// defines.
template <typename T>
inline constexpr std::size_t kAbiMinimum = T::kMinimum;

template <>
inline constexpr std::size_t kAbiMinimum<SluiceError> = offsetof(SluiceError, message) + sizeof(SluiceError::message);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceTraceEvent> = offsetof(SluiceTraceEvent, name) +
                                                             sizeof(SluiceTraceEvent::name);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceImageExport> = offsetof(SluiceImageExport, dedicated) +
                                                              sizeof(SluiceImageExport::dedicated);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceHostServices> = offsetof(SluiceHostServices, canary) +
                                                               sizeof(SluiceHostServices::canary);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceHostCapabilities> = offsetof(SluiceHostCapabilities, reserved) +
                                                                   sizeof(SluiceHostCapabilities::reserved);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceRendererCapabilities> = offsetof(SluiceRendererCapabilities, reserved) +
                                                                       sizeof(SluiceRendererCapabilities::reserved);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceParticles> = offsetof(SluiceParticles, colour) +
                                                            sizeof(SluiceParticles::colour);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceEnvironment> = offsetof(SluiceEnvironment, pixels) +
                                                              sizeof(SluiceEnvironment::pixels);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceSceneNeeds> = offsetof(SluiceSceneNeeds, fluid) +
                                                             sizeof(SluiceSceneNeeds::fluid);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceFrame> = offsetof(SluiceFrame, fluid) + sizeof(SluiceFrame::fluid);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceFrameStats> = offsetof(SluiceFrameStats, validation_messages) +
                                                             sizeof(SluiceFrameStats::validation_messages);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceCreateInfo> = offsetof(SluiceCreateInfo, host) +
                                                             sizeof(SluiceCreateInfo::host);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceRendererInfo> = offsetof(SluiceRendererInfo, capabilities) +
                                                               sizeof(SluiceRendererInfo::capabilities);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceRendererApi> = offsetof(SluiceRendererApi, destroy) +
                                                              sizeof(SluiceRendererApi::destroy);

template <>
inline constexpr std::size_t kAbiMinimum<SluiceSimulation> = offsetof(SluiceSimulation, velocity) +
                                                             sizeof(SluiceSimulation::velocity);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceSimulationStats> = offsetof(SluiceSimulationStats, message) +
                                                                  sizeof(SluiceSimulationStats::message);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceBodies> = offsetof(SluiceBodies, bodies) + sizeof(SluiceBodies::bodies);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceBodyTarget> = offsetof(SluiceBodyTarget, turn) +
                                                             sizeof(SluiceBodyTarget::turn);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceFlow> = offsetof(SluiceFlow, emitters) + sizeof(SluiceFlow::emitters);
template <>
inline constexpr std::size_t kAbiMinimum<SluiceStart> = offsetof(SluiceStart, velocity) + sizeof(SluiceStart::velocity);

/// An empty T that says its size.
template <typename T>
[[nodiscard]] T sized() noexcept {
    T value{};
    value.struct_size = sizeof(T);
    return value;
}

/// The struct is there and not shorter than in ABI 1.0. INVALID_ARGUMENT otherwise, naming `name` and both sizes.
template <typename T>
[[nodiscard]] Status checkAbiStruct(const T* given, std::string_view name) {
    if (given == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, std::string(name), "it is NULL", ""};
    }
    if (given->struct_size < kAbiMinimum<T>) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, std::string(name),
                     "struct_size is " + std::to_string(given->struct_size) + ", at least " +
                         std::to_string(kAbiMinimum<T>) + " is needed",
                     "set it to sizeof"};
    }
    return {};
}

/// A copy in which every field that `given` is too short for is zero, and what is beyond T is left out. The struct has
/// passed checkAbiStruct.
template <typename T>
[[nodiscard]] T readAbiStruct(const T& given) noexcept {
    T copy{};
    std::memcpy(&copy, &given, std::min<std::size_t>(given.struct_size, sizeof(T)));
    copy.struct_size = sizeof(T);
    return copy;
}

/// Fills a struct of the other side as far as it reaches. Its struct_size then says how much was filled.
template <typename T>
[[nodiscard]] Status writeAbiStruct(T* to, const T& from, std::string_view name) {
    if (Status status = checkAbiStruct(to, name); !status) {
        return status;
    }
    const std::size_t size = std::min<std::size_t>(to->struct_size, sizeof(T));
    std::memcpy(to, &from, size);
    to->struct_size = static_cast<std::uint32_t>(size);
    return {};
}

}  // namespace sluice
