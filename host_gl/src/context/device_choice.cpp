// SPDX-License-Identifier: MIT
#include "context/device_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <system_error>

namespace sluice::host {

namespace {

constexpr std::array<std::string_view, 3> kSoftwareRenderers{"llvmpipe", "softpipe", "swrast"};

}  // namespace

Result<GlDeviceChoice> parseGlDevice(std::string_view text) {
    if (text.empty() || text == "surfaceless") {
        return GlDeviceChoice{};
    }
    std::size_t index = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, code] = std::from_chars(text.data(), end, index);
    if (code != std::errc{} || stopped != end) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, kGlDeviceVariable,
                     fmt::format("expected 'surfaceless' or the index of an EGL device, found '{}'", text),
                     "see the list of EGL devices in 'sluice probe', or unset the variable"};
    }
    return GlDeviceChoice{index};
}

std::string glDeviceVariable() {
    const char* text = std::getenv(kGlDeviceVariable);
    return text != nullptr ? text : "";
}

Result<GlDeviceChoice> glDeviceFromEnvironment() {
    return parseGlDevice(glDeviceVariable());
}

std::string deviceNote(std::string_view renderer, std::string_view asked, const std::vector<bool>& software) {
    const bool draws_in_software =
        std::any_of(kSoftwareRenderers.begin(), kSoftwareRenderers.end(),
                    [&](std::string_view part) { return renderer.find(part) != std::string_view::npos; });
    if (!draws_in_software) {
        return {};
    }
    if (asked.empty()) {
        const auto card = std::find(software.begin(), software.end(), false);
        if (card == software.end()) {
            return {};
        }
        const auto index = card - software.begin();
        return fmt::format("OpenGL is the software renderer '{}' although EGL device {} is none; set {}={} to use it",
                           renderer, index, kGlDeviceVariable, index);
    }
    const Result<GlDeviceChoice> choice = parseGlDevice(asked);
    const bool asked_for_card =
        choice && choice.value() && *choice.value() < software.size() && !software[*choice.value()];
    if (!asked_for_card) {
        return {};
    }
    return fmt::format(
        "{}={} names an EGL device that is no software renderer, but OpenGL on it is '{}'; install the "
        "OpenGL driver of that device, or unset the variable",
        kGlDeviceVariable, asked, renderer);
}

}  // namespace sluice::host
