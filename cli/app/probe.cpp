// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cstdio>

#include "app/commands.hpp"
#include "app/log.hpp"
#include "app/plugin_path.hpp"
#include "report/probe_report.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/canary.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/context.hpp"
#include "sluice/host_gl/fluid_host.hpp"

namespace sluice::cli {
namespace {

/// The canary's own size, and one larger than any tile of a driver, odd too.
constexpr std::array<scene::Size, 2> kSizes{{{kCanaryWidth, kCanaryHeight}, {1283, 717}}};

bool has(std::uint32_t formats, SluiceFormat format) {
    return (formats & formatBit(format)) != 0;
}

SluiceCreateInfo createInfo(const ProbeResult& result, const ProbeOptions& options) {
    auto info = sized<SluiceCreateInfo>();
    info.width = kSizes[1].width;
    info.height = kSizes[1].height;
    info.image_sets = 1;
    info.validation = options.validation ? 1 : 0;
    info.host = result.gl;
    return info;
}

FormatProbe probeFormat(const FormatInfo& format, const ProbeResult& result, const SluiceRendererApi& api,
                        const SluiceHostServices& services, const SluiceCreateInfo& info) {
    FormatProbe probe;
    probe.format = format.format;
    probe.gl_texture = has(result.gl.texture_formats, format.format);
    probe.gl_attachment = has(result.gl.attachment_formats, format.format);
    probe.vk_exportable = has(result.vk->exportable_formats, format.format);
    probe.vk_storage = has(result.vk->storage_formats, format.format);
    probe.vk_blendable = has(result.vk->blendable_formats, format.format);
    // Without the means of sharing at all, every format would fail for the one reason that negotiation gives.
    if (!probe.gl_texture || !probe.vk_exportable || result.gl.has_memory_object_fd == 0) {
        return probe;
    }
    for (const scene::Size size : kSizes) {
        auto error = sized<SluiceError>();
        const SluiceResult code = api.probe_format(&services, &info, static_cast<std::uint32_t>(format.format),
                                                   size.width, size.height, &error);
        probe.canaries.push_back({size.width, size.height, code == SLUICE_OK, code == SLUICE_OK ? "" : error.message});
    }
    return probe;
}

/// Each kind by itself, then what AUTO takes.
void negotiateAll(ProbeResult& result) {
    NegotiationRequest request;
    request.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);
    for (const FormatProbe& format : result.formats) {
        if (!format.canaries.empty() && !format.shared()) {
            request.failed_formats |= formatBit(format.format);
        }
    }
    const Result<Agreement> agreed = negotiate(result.gl, *result.vk, request);
    if (agreed) {
        result.agreement = agreed.value();
    } else {
        result.problems.push_back(agreed.error().message());
    }
    constexpr std::array kKinds{SLUICE_TIMELINE_NATIVE, SLUICE_TIMELINE_BINARY, SLUICE_TIMELINE_BRIDGED,
                                SLUICE_TIMELINE_FINISH};
    for (const SluiceTimelineKind kind : kKinds) {
        request.timeline = kind;
        const Result<Agreement> alone = negotiate(result.gl, *result.vk, request);
        TimelineProbe timeline{kind, alone.ok(), agreed && agreed.value().timeline == kind, {}};
        if (!alone) {
            timeline.why = alone.error().detail;
        } else if (timeline.chosen) {
            timeline.why = "the best that is possible";
        } else {
            timeline.why = agreed ? fmt::format("{} is better", toString(agreed.value().timeline)) : "";
        }
        result.timelines.push_back(std::move(timeline));
    }
}

void probeRenderer(ProbeResult& result, const ProbeOptions& options) {
    const Result<host::PluginLibrary> library = loadPlugin(options.plugin);
    if (!library) {
        result.problems.push_back(library.error().message());
        return;
    }
    const SluiceRendererApi& api = library.value().api();
    result.renderer = fmt::format("{} {}", api.name, api.version);
    result.plugin = library.value().path().string();
    const host::ProbeServices services([](SluiceLogLevel level, std::string_view message) { log(level, message); });
    const SluiceCreateInfo info = createInfo(result, options);
    auto vk = sized<SluiceRendererCapabilities>();
    auto error = sized<SluiceError>();
    if (api.describe(&services.services(), &info, &vk, &error) != SLUICE_OK) {
        result.problems.emplace_back(error.message);
        return;
    }
    result.vk = vk;
    result.same_device = sameDevice(result.gl, vk);
    if (result.same_device) {
        for (const FormatInfo& format : formatTable()) {
            result.formats.push_back(probeFormat(format, result, api, services.services(), info));
        }
    }
    negotiateAll(result);
}

}  // namespace

int probe(const ProbeOptions& options) {
    ProbeResult result;
    Result<host::GlContext> context = host::GlContext::create();
    Status current = context ? context.value().makeCurrent() : Status{context.error()};
    if (!current) {
        result.problems.push_back(current.error().message());
    } else {
        result.gl = host::queryCapabilities();
        result.gl_device_note = host::glDeviceNote();
        probeRenderer(result, options);
    }
    result.egl_devices = host::eglDevices();
    if (options.json) {
        fmt::print("{}\n", probeJson(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else {
        fmt::print("{}", probeText(result));
    }
    return result.possible() ? kExitOk : kExitNoFluid;
}

}  // namespace sluice::cli
