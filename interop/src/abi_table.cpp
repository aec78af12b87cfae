// SPDX-License-Identifier: MIT
#include "sluice/abi_table.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <utility>

#include "sluice/abi_sizes.hpp"

namespace sluice {

namespace {

constexpr const char* kRebuild = "build host and plugin from the same sluice/plugin.h";

/// The first function of ABI 1.0 that is NULL, or nullptr.
const char* firstMissing(const SluiceRendererApi& api) {
    const std::array<std::pair<const char*, bool>, 16> present{{
        {"describe", api.describe != nullptr},
        {"explain", api.explain != nullptr},
        {"create", api.create != nullptr},
        {"info", api.info != nullptr},
        {"resize", api.resize != nullptr},
        {"set_particles", api.set_particles != nullptr},
        {"set_environment", api.set_environment != nullptr},
        {"submit_frame", api.submit_frame != nullptr},
        {"poll", api.poll != nullptr},
        {"timeline_signal", api.timeline_signal != nullptr},
        {"timeline_wait", api.timeline_wait != nullptr},
        {"timeline_value", api.timeline_value != nullptr},
        {"timeline_export", api.timeline_export != nullptr},
        {"probe_format", api.probe_format != nullptr},
        {"destroy", api.destroy != nullptr},
        {"name", api.name != nullptr},
    }};
    for (const auto& [name, is_present] : present) {
        if (!is_present) {
            return name;
        }
    }
    return nullptr;
}

constexpr std::uint32_t majorOf(std::uint32_t version) {
    return version >> 16U;
}

}  // namespace

Status checkRendererTable(const std::string& thing, const SluiceRendererApi* api) {
    if (api == nullptr) {
        return Error{
            SLUICE_ERROR_ABI_MISMATCH, thing,
            fmt::format("does not serve ABI {}.{}: its entry returned no table", SLUICE_ABI_MAJOR, SLUICE_ABI_MINOR),
            kRebuild};
    }
    // The version stands before the functions, so it can be read whatever the size of the rest.
    constexpr std::size_t kHead = offsetof(SluiceRendererApi, abi_version) + sizeof(std::uint32_t);
    if (api->struct_size < kHead || majorOf(api->abi_version) != SLUICE_ABI_MAJOR) {
        const std::uint32_t found = api->struct_size < kHead ? 0 : majorOf(api->abi_version);
        return Error{SLUICE_ERROR_ABI_MISMATCH, thing,
                     fmt::format("expected ABI major {}, found {}", SLUICE_ABI_MAJOR, found), kRebuild};
    }
    if (api->struct_size < kAbiMinimum<SluiceRendererApi>) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, thing,
                     fmt::format("expected a function table of at least {} bytes, found {}",
                                 kAbiMinimum<SluiceRendererApi>, api->struct_size),
                     kRebuild};
    }
    if (const char* missing = firstMissing(*api)) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, thing, fmt::format("the function table has NULL for '{}'", missing),
                     kRebuild};
    }
    return {};
}

}  // namespace sluice
