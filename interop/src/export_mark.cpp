// SPDX-License-Identifier: MIT
#include "sluice/export_mark.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

#include "sluice/format.hpp"
#include "sluice/trace.hpp"

namespace sluice {
namespace {

constexpr std::string_view kVerb = "export ";
constexpr std::size_t kLongest = 31;  // as the receiver of a trace event keeps it
constexpr std::uint64_t kNoDescriptor = 0xFFFFFFFF;

}  // namespace

void markExport(const SluiceHostServices& host, const SluiceImageExport& image) {
    if (host.trace == nullptr || image.role >= SLUICE_IMAGE_ROLE_COUNT) {
        return;
    }
    std::array<char, kLongest + 1> name{};
    fmt::format_to_n(name.begin(), kLongest, "{}{}[{}]", kVerb, toString(static_cast<SluiceImageRole>(image.role)),
                     image.image_set);
    SluiceTraceEvent event{};
    event.struct_size = sizeof(event);
    event.kind = SLUICE_TRACE_MARK;
    event.track = SLUICE_TRACK_RENDERER_CPU;
    event.begin_ns = monotonicNanoseconds();
    event.value = std::uint64_t{image.dedicated} << 32U | static_cast<std::uint32_t>(image.fd);
    event.bytes = image.allocation_size;
    event.name = name.data();
    host.trace(host.user, &event);
}

std::optional<ExportMark> exportMark(const SluiceTraceEvent& event) {
    if (event.kind != SLUICE_TRACE_MARK || event.track != SLUICE_TRACK_RENDERER_CPU || event.name == nullptr) {
        return std::nullopt;
    }
    const std::string_view name(event.name, strnlen(event.name, kLongest));
    const std::size_t bracket = name.find('[');
    if (!name.starts_with(kVerb) || !name.ends_with(']') || bracket == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string_view role = name.substr(kVerb.size(), bracket - kVerb.size());
    const std::string_view set = name.substr(bracket + 1, name.size() - bracket - 2);
    ExportMark mark;
    const auto [end, failure] = std::from_chars(set.data(), set.data() + set.size(), mark.image_set);
    while (mark.role < SLUICE_IMAGE_ROLE_COUNT && toString(static_cast<SluiceImageRole>(mark.role)) != role) {
        ++mark.role;
    }
    if (failure != std::errc{} || end != set.data() + set.size() || mark.image_set >= SLUICE_MAX_IMAGE_SETS ||
        mark.role == SLUICE_IMAGE_ROLE_COUNT) {
        return std::nullopt;
    }
    mark.size = event.bytes;
    mark.dedicated = static_cast<std::uint32_t>(event.value >> 32U);
    mark.fd = static_cast<std::int32_t>(static_cast<std::uint32_t>(event.value));
    return mark;
}

std::uint64_t valueElsewhere(const SluiceTraceEvent& event) {
    return exportMark(event) ? event.value | kNoDescriptor : event.value;
}

}  // namespace sluice
