// SPDX-License-Identifier: MIT
#include "report/probe_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "report/table.hpp"
#include "sluice/format.hpp"
#include "sluice/uuid.hpp"

namespace sluice::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* yes(bool value) {
    return value ? "yes" : "-";
}

/// VK_API_VERSION_MAJOR and so on, which this program has no Vulkan header for.
std::string vulkanVersion(std::uint32_t version) {
    return fmt::format("{}.{}.{}", (version >> 22U) & 0x7FU, (version >> 12U) & 0x3FFU, version & 0xFFFU);
}

struct Ability {
    const char* name;
    bool present;
};

std::vector<Ability> glAbilities(const SluiceHostCapabilities& gl) {
    return {{"GL_EXT_memory_object", gl.has_memory_object != 0},
            {"GL_EXT_memory_object_fd", gl.has_memory_object_fd != 0},
            {"GL_EXT_semaphore", gl.has_semaphore != 0},
            {"GL_EXT_semaphore_fd", gl.has_semaphore_fd != 0},
            {"GL_NV_timeline_semaphore", gl.has_timeline_semaphore != 0},
            {"sync objects", gl.has_sync != 0},
            {"framebuffer objects", gl.has_framebuffer_object != 0}};
}

std::vector<Ability> vkAbilities(const SluiceRendererCapabilities& vk) {
    return {{"VK_KHR_external_memory_fd", vk.has_external_memory_fd != 0},
            {"timeline semaphores", vk.has_timeline_semaphore != 0},
            {"timeline semaphore as opaque fd", vk.exports_timeline_fd != 0},
            {"binary semaphore as opaque fd", vk.exports_binary_fd != 0}};
}

std::string sides(const ProbeResult& probe) {
    const SluiceHostCapabilities& gl = probe.gl;
    if (gl.renderer[0] == '\0') {
        return "OpenGL    none: see the problem below\n";
    }
    std::string text = fmt::format("OpenGL    {} / {} / {}\n", gl.vendor, gl.renderer, gl.version);
    for (std::uint32_t i = 0; i < std::min(gl.device_uuid_count, SLUICE_MAX_DEVICE_UUIDS); ++i) {
        text += fmt::format("          device UUID {}\n", uuidText(gl.device_uuids[i]));
    }
    text += fmt::format("          driver UUID {}\n", uuidText(gl.driver_uuid));
    if (probe.vk) {
        const SluiceRendererCapabilities& vk = *probe.vk;
        text += fmt::format("Vulkan    {} / {} / {} / {}\n", vk.device_name, vk.driver_name, vk.driver_info,
                            vulkanVersion(vk.api_version));
        text += fmt::format("          device UUID {}\n          driver UUID {}\n", uuidText(vk.device_uuid),
                            uuidText(vk.driver_uuid));
        text += fmt::format("          {} queue families, {} queues\n", vk.queue_families, vk.queues);
        text +=
            fmt::format("devices   {}\n", probe.same_device ? "one device and one driver on both sides"
                                                            : "different devices or drivers: nothing can be shared");
    }
    std::vector<std::vector<std::string>> rows{{"ability", "side", "there"}};
    for (const Ability& ability : glAbilities(gl)) {
        rows.push_back({ability.name, "OpenGL", yes(ability.present)});
    }
    if (probe.vk) {
        for (const Ability& ability : vkAbilities(*probe.vk)) {
            rows.push_back({ability.name, "Vulkan", yes(ability.present)});
        }
    }
    return text + "\n" + formatTable(rows, {});
}

/// The number of `why` among those seen so far: one missing ability fails every format with the same words.
std::size_t noteOf(std::vector<std::string>& notes, const std::string& why) {
    const auto at = std::find(notes.begin(), notes.end(), why);
    const auto index = static_cast<std::size_t>(at - notes.begin());
    if (at == notes.end()) {
        notes.push_back(why);
    }
    return index + 1;
}

std::string formatsTable(const ProbeResult& probe) {
    std::vector<std::string> notes;
    std::vector<std::vector<std::string>> rows{
        {"format", "GL texture", "GL attachment", "VK export", "VK storage", "VK blend", "canary VK->GL->VK"}};
    for (const FormatProbe& format : probe.formats) {
        std::string canary;
        for (const CanaryTrial& trial : format.canaries) {
            canary += fmt::format("{}{}x{} {}", canary.empty() ? "" : ", ", trial.width, trial.height,
                                  trial.passed ? "equal" : fmt::format("FAILED [{}]", noteOf(notes, trial.why)));
        }
        rows.push_back({std::string(findFormat(format.format)->name), yes(format.gl_texture), yes(format.gl_attachment),
                        yes(format.vk_exportable), yes(format.vk_storage), yes(format.vk_blendable),
                        canary.empty() ? "not tried" : canary});
    }
    std::string text = formatTable(rows, {});
    for (std::size_t i = 0; i < notes.size(); ++i) {
        text += fmt::format("[{}] {}\n", i + 1, notes[i]);
    }
    return text;
}

std::string timelinesTable(const ProbeResult& probe) {
    std::vector<std::vector<std::string>> rows{{"timeline", "possible", "chosen", "why"}};
    for (const TimelineProbe& timeline : probe.timelines) {
        rows.push_back(
            {std::string(toString(timeline.kind)), yes(timeline.possible), yes(timeline.chosen), timeline.why});
    }
    return formatTable(rows, {});
}

std::string agreementText(const Agreement& agreement) {
    std::string text = fmt::format("agreement timeline {}", toString(agreement.timeline));
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
        const FormatInfo* info = findFormat(static_cast<std::uint32_t>(agreement.formats[role]));
        if (info != nullptr) {
            text += fmt::format("\n          {} {}", toString(static_cast<SluiceImageRole>(role)), info->name);
        }
    }
    return text + "\n";
}

Json abilitiesJson(const std::vector<Ability>& abilities) {
    Json object = Json::object();
    for (const Ability& ability : abilities) {
        object[ability.name] = ability.present;
    }
    return object;
}

Json glJson(const SluiceHostCapabilities& gl) {
    Json uuids = Json::array();
    for (std::uint32_t i = 0; i < std::min(gl.device_uuid_count, SLUICE_MAX_DEVICE_UUIDS); ++i) {
        uuids.push_back(uuidText(gl.device_uuids[i]));
    }
    return {{"vendor", gl.vendor},
            {"renderer", gl.renderer},
            {"version", gl.version},
            {"device_uuids", uuids},
            {"driver_uuid", uuidText(gl.driver_uuid)},
            {"abilities", abilitiesJson(glAbilities(gl))}};
}

Json vkJson(const SluiceRendererCapabilities& vk) {
    return {{"device", vk.device_name},
            {"driver", vk.driver_name},
            {"driver_info", vk.driver_info},
            {"api_version", vulkanVersion(vk.api_version)},
            {"device_uuid", uuidText(vk.device_uuid)},
            {"driver_uuid", uuidText(vk.driver_uuid)},
            {"queue_families", vk.queue_families},
            {"queues", vk.queues},
            {"abilities", abilitiesJson(vkAbilities(vk))}};
}

Json formatJson(const FormatProbe& format) {
    Json canaries = Json::array();
    for (const CanaryTrial& trial : format.canaries) {
        canaries.push_back({{"size", {trial.width, trial.height}}, {"passed", trial.passed}, {"why", trial.why}});
    }
    return {{"format", findFormat(format.format)->name},
            {"gl_texture", format.gl_texture},
            {"gl_attachment", format.gl_attachment},
            {"vk_exportable", format.vk_exportable},
            {"vk_storage", format.vk_storage},
            {"vk_blendable", format.vk_blendable},
            {"canaries", canaries},
            {"shared", format.shared()}};
}

Json agreementJson(const Agreement& agreement) {
    Json formats = Json::object();
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_CANARY; ++role) {
        const FormatInfo* info = findFormat(static_cast<std::uint32_t>(agreement.formats[role]));
        formats[std::string(toString(static_cast<SluiceImageRole>(role)))] = info == nullptr ? "none" : info->name;
    }
    Json reasons = Json::array();
    for (const Reason& reason : agreement.reasons) {
        reasons.push_back({{"subject", reason.subject}, {"accepted", reason.accepted}, {"why", reason.why}});
    }
    return {{"timeline", toString(agreement.timeline)},
            {"formats", formats},
            {"host_depth_encoding", agreement.host_depth_encoding == SLUICE_DEPTH_LINEAR ? "linear" : "window"},
            {"reasons", reasons}};
}

}  // namespace

bool FormatProbe::shared() const {
    return !canaries.empty() &&
           std::all_of(canaries.begin(), canaries.end(), [](const CanaryTrial& trial) { return trial.passed; });
}

std::string probeText(const ProbeResult& probe) {
    std::string text = sides(probe);
    if (!probe.formats.empty()) {
        text += "\n" + formatsTable(probe);
    }
    if (!probe.timelines.empty()) {
        text += "\n" + timelinesTable(probe);
    }
    text += "\n";
    if (probe.agreement) {
        text += agreementText(*probe.agreement);
    }
    for (const std::string& problem : probe.problems) {
        text += fmt::format("problem   {}\n", problem);
    }
    if (!probe.gl_device_note.empty()) {
        text += fmt::format("note      {}\n", probe.gl_device_note);
    }
    text += fmt::format("verdict   GL and Vulkan {} share images here.\n", probe.possible() ? "can" : "cannot");
    text += "\nEGL devices\n";
    for (const std::string& device : probe.egl_devices) {
        text += fmt::format("  {}\n", device);
    }
    if (probe.egl_devices.empty()) {
        text += "  none: EGL cannot list them here\n";
    }
    return text;
}

nlohmann::ordered_json probeJson(const ProbeResult& probe) {
    Json formats = Json::array();
    for (const FormatProbe& format : probe.formats) {
        formats.push_back(formatJson(format));
    }
    Json timelines = Json::array();
    for (const TimelineProbe& timeline : probe.timelines) {
        timelines.push_back({{"kind", toString(timeline.kind)},
                             {"possible", timeline.possible},
                             {"chosen", timeline.chosen},
                             {"why", timeline.why}});
    }
    return {{"sluice", SLUICE_VERSION},
            {"possible", probe.possible()},
            {"renderer", probe.renderer},
            {"plugin", probe.plugin},
            {"gl", glJson(probe.gl)},
            {"vulkan", probe.vk ? vkJson(*probe.vk) : Json(nullptr)},
            {"same_device", probe.same_device},
            {"formats", formats},
            {"timelines", timelines},
            {"agreement", probe.agreement ? agreementJson(*probe.agreement) : Json(nullptr)},
            {"problems", probe.problems},
            {"gl_device_note", probe.gl_device_note.empty() ? Json(nullptr) : Json(probe.gl_device_note)},
            {"egl_devices", probe.egl_devices}};
}

}  // namespace sluice::cli
