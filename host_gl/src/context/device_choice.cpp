// SPDX-License-Identifier: MIT
#include "context/device_choice.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <system_error>

namespace sluice::host {

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

Result<GlDeviceChoice> glDeviceFromEnvironment() {
    const char* text = std::getenv(kGlDeviceVariable);
    return parseGlDevice(text != nullptr ? text : "");
}

}  // namespace sluice::host
