// SPDX-License-Identifier: MIT
// What the payload saw in a program, for people.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/inject.hpp"

namespace sluice::cli {

namespace {

using Json = nlohmann::ordered_json;

std::vector<Json> readReports(const std::string& folder) {
    std::vector<Json> reports;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (entry.path().extension() == ".json") {
            std::ifstream file(entry.path(), std::ios::binary);
            Json report = Json::parse(file, nullptr, false);
            if (report.is_object()) {
                reports.push_back(std::move(report));
            }
        }
    }
    std::sort(reports.begin(), reports.end(),
              [](const Json& a, const Json& b) { return a.at("process") < b.at("process"); });
    return reports;
}

std::string millisecondsEach(const Json& seconds, double frames) {
    return fmt::format("{:.3f} ms", frames > 0 ? seconds.get<double>() * 1e3 / frames : 0.0);
}

std::string sayCamera(const Json& context) {
    const Json& camera = context.at("camera");
    if (camera.is_null()) {
        return "  camera     none found: no fluid (see the rejected matrices, and camera in the profile)\n";
    }
    return fmt::format(
        "  camera     near {:.4g}, far {:.4g}; {}; confidence {:.2f}\n"
        "  view       {}; confidence {:.2f}\n",
        camera.at("near").get<double>(), camera.at("far").get<double>(), camera.at("source").get<std::string>(),
        camera.at("confidence").get<double>(), camera.at("view_source").get<std::string>(),
        camera.at("view_confidence").get<double>());
}

std::string sayFrame(const Json& context) {
    const Json& frame = context.at("last_frame");
    std::string text;
    for (const Json& lens : frame.at("lenses")) {
        text += fmt::format("  lens       near {:.4g}, far {:.4g}: {} vertices in {} draws, {} matrices ({})\n",
                            lens.at("near").get<double>(), lens.at("far").get<double>(),
                            lens.at("vertices").get<std::uint64_t>(), lens.at("draws").get<std::uint64_t>(),
                            lens.at("matrices").get<std::uint64_t>(), lens.at("source").get<std::string>());
    }
    text += fmt::format(
        "  overlay    {} changes to it in the last frame, {} draws without perspective; fluid before it "
        "in {} of {} frames\n",
        frame.at("switches_to_overlay").get<std::uint64_t>(), frame.at("flat_draws").get<std::uint64_t>(),
        context.at("frames_with_fluid_before_overlay").get<std::uint64_t>(), context.at("frames").get<std::uint64_t>());
    const auto target = frame.at("scene_in_framebuffer").get<std::uint32_t>();
    const auto others = frame.at("draws_into_other_framebuffers").get<std::uint64_t>();
    if (target != 0 || others > 0) {
        text += fmt::format("  scene in   {}; {} draws into others\n",
                            target == 0 ? "the window" : fmt::format("framebuffer {} of the program's own", target),
                            others);
    }
    for (const auto& [reason, count] : frame.at("rejected").items()) {
        text += fmt::format("  rejected   {} matrices: {}\n", count.get<std::uint64_t>(), reason);
    }
    return text;
}

/// An axis by its name, any other by its numbers.
std::string direction(const Json& vector) {
    const auto [x, y, z] = vector.get<std::array<double, 3>>();
    if (x == 0.0 && y == 0.0 && z > 0.0) {
        return "+z";
    }
    return x == 0.0 && z == 0.0 && y > 0.0 ? "+y" : fmt::format("({:.4g}, {:.4g}, {:.4g})", x, y, z);
}

std::string sayFluid(const Json& context) {
    const Json& fluid = context.at("fluid");
    const auto frames = fluid.at("frames").get<double>();
    std::string text;
    if (const auto failure = context.at("failure").get<std::string>(); !failure.empty()) {
        text += fmt::format("  given up   {}\n", failure);
    }
    if (frames > 0) {
        const Json& s = fluid.at("seconds");
        text += fmt::format(
            "  fluid      {} frames, {} without; {} particles, {} steps, {} renderer(s), on {}; {:.4g} units "
            "per metre, up is {}\n",
            fluid.at("frames").get<std::uint64_t>(), fluid.at("frames_without").get<std::uint64_t>(),
            fluid.at("particles").get<std::uint64_t>(), fluid.at("steps").get<std::uint64_t>(),
            fluid.at("renderers").get<std::uint64_t>(), fluid.at("device").get<std::string>(),
            fluid.at("units_per_metre").get<double>(), direction(fluid.at("up")));
        const auto each = [&](const char* key) { return millisecondsEach(s.at(key), frames); };
        text += fmt::format("  cost       per frame with fluid: capture {}, hand-off {}, fluid {}, composite {}\n",
                            each("capture"), each("hand_off"), each("fluid"), each("composite"));
        text += fmt::format("             in all {} of the program's thread; the simulation {} beside it\n",
                            each("whole"), each("simulation"));
    }
    return text;
}

std::string sayContext(const Json& context, int number) {
    std::string swaps;
    for (const auto& [route, count] : context.at("swaps_by").items()) {
        swaps += fmt::format("{}{} {}", swaps.empty() ? "" : ", ", route, count.get<std::uint64_t>());
    }
    const Json& size = context.at("size");
    const auto version = context.at("version").get<std::string>();
    std::string text = fmt::format("context {}: {}, {}{} on {}{}\n", number, context.at("api").get<std::string>(),
                                   version.starts_with("OpenGL ES") ? "" : "OpenGL ", version,
                                   context.at("renderer").get<std::string>(),
                                   context.at("ended").get<bool>() ? ", destroyed by the program" : "");
    text += fmt::format("  drawable   {}x{}, depth {} bits, stencil {} bits, {} samples, {} resizes\n",
                        size.at(0).get<std::uint32_t>(), size.at(1).get<std::uint32_t>(),
                        context.at("depth_bits").get<int>(), context.at("stencil_bits").get<int>(),
                        context.at("samples").get<int>(), context.at("resizes").get<std::uint32_t>());
    text += fmt::format("  frames     {} by {}\n", context.at("frames").get<std::uint64_t>(), swaps);
    text += sayCamera(context) + sayFrame(context) + sayFluid(context);
    const Json& spent = context.at("own_seconds");
    text +=
        fmt::format("  in all     {} per frame beside the program's own work (the hooks of its calls not counted)\n",
                    millisecondsEach(spent.at("sum"), spent.at("frames").get<double>()));
    const Json& leaks = context.at("state_leaks");
    if (context.at("in_own_context").get<bool>()) {
        return text + "  GL state   untouched: the fluid is drawn in a context of its own\n";
    }
    text += fmt::format("  GL state   {} frames compared before and after: {}\n",
                        context.at("audited_frames").get<std::uint64_t>(),
                        leaks.empty() ? "no difference" : fmt::format("{} DIFFERENCES", leaks.size()));
    for (const Json& leak : leaks) {
        text += fmt::format("             {}\n", leak.get<std::string>());
    }
    return text;
}

std::string sayProcess(const Json& report) {
    std::string text = fmt::format("process {}\n", report.at("process").get<int>());
    int number = 0;
    for (const Json& context : report.at("contexts")) {
        text += sayContext(context, ++number);
    }
    if (const auto other = report.at("swaps_of_other_drawables").get<std::uint64_t>(); other > 0) {
        text += fmt::format("{} swaps of windows that the current context did not draw into\n", other);
    }
    text += "hooked calls\n";
    for (const Json& hook : report.at("hooks")) {
        text += fmt::format("  {:<34} {:>10}  by {}\n", hook.at("name").get<std::string>(),
                            hook.at("calls").get<std::uint64_t>(), hook.at("by").get<std::string>());
    }
    return text;
}

}  // namespace

std::string injectReport(const std::string& folder, bool json) {
    const std::vector<Json> reports = readReports(folder);
    if (json) {
        return Json(reports).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    }
    if (reports.empty()) {
        return "No frame of OpenGL was seen: nothing was swapped, or by a process that did not get the shim "
               "(--children),\n"
               "or by a program that is not linked dynamically.\n";
    }
    std::string text;
    try {
        for (const Json& report : reports) {
            text += sayProcess(report);
        }
    } catch (const Json::exception& fault) {
        // The program has run, and its exit code matters more.
        text += fmt::format("the report cannot be read: {} (install Sluice as a whole)\n", fault.what());
    }
    return text;
}

}  // namespace sluice::cli
