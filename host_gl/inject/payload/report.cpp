// SPDX-License-Identifier: MIT
#include "payload/report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace sluice::inject {

namespace {

using Json = nlohmann::ordered_json;

Json cameraJson(const FoundCamera& camera) {
    return {{"near", camera.lens.near_plane},
            {"far", camera.lens.far_plane},
            {"scale", {camera.lens.scale_x, camera.lens.scale_y}},
            {"shift", {camera.lens.shift_x, camera.lens.shift_y}},
            {"source", camera.source},
            {"confidence", camera.confidence},
            {"view", camera.view},
            {"view_source", camera.view_source},
            {"view_confidence", camera.view_confidence},
            {"vertices", camera.vertices}};
}

Json frameJson(const FrameTracker& tracker) {
    const FrameSummary& frame = tracker.lastFrame();
    Json lenses = Json::array();
    for (const SeenLens& seen : frame.lenses) {
        lenses.push_back({{"near", seen.lens.near_plane},
                          {"far", seen.lens.far_plane},
                          {"source", seen.source},
                          {"vertices", seen.vertices},
                          {"draws", seen.draws},
                          {"matrices", seen.matrices}});
    }
    return {{"lenses", lenses},
            {"flat_draws", frame.flat_draws},
            {"scene_in_framebuffer", frame.target},
            {"draws_into_other_framebuffers", frame.foreign_draws},
            {"switches_to_overlay", frame.switches},
            {"fluid_before_overlay", frame.composited_early},
            {"rejected", frame.rejected}};
}

Json waterJson(const WaterReport& water) {
    return {{"frames", water.frames},
            {"frames_without", water.frames_without},
            {"particles", water.particles},
            {"steps", water.steps},
            {"renderers", water.renderers},
            {"device", water.device},
            {"units_per_metre", water.units_per_metre},
            {"up", water.up},
            {"restarts", water.restarts},
            {"placements", water.placements},
            {"last_error", water.last_error},
            {"seconds",
             {{"capture", water.capture_s},
              {"hand_off", water.hand_off_s},
              {"fluid", water.fluid_s},
              {"simulation", water.simulation_s},
              {"composite", water.composite_s},
              {"whole", water.whole_s},
              {"begin", water.begin_s}}}};
}

Json sessionJson(Session& session) {
    const ContextFacts& facts = session.facts();
    const std::optional<FoundCamera> camera = std::as_const(session).tracker().camera();
    return {{"api", session.identity().api == SLUICE_INJECT_GLX ? "GLX" : "EGL"},
            {"version", facts.version},
            {"renderer", facts.renderer},
            {"fixed_function", facts.compatibility},
            {"depth_bits", facts.depth_bits},
            {"stencil_bits", facts.stencil_bits},
            {"samples", facts.samples},
            {"size", {session.size().width, session.size().height}},
            {"resizes", session.resizes()},
            {"frames", session.frames()},
            {"swaps_by", session.routes()},
            {"ended", session.ended()},
            {"camera", camera ? cameraJson(*camera) : Json(nullptr)},
            {"last_frame", frameJson(session.tracker())},
            {"frames_with_fluid_before_overlay", session.earlyFrames()},
            {"fluid", waterJson(session.water())},
            {"failure", session.failure()},
            {"in_own_context", facts.embedded},
            {"audited_frames", session.audits()},
            {"state_leaks", session.leaks()},
            {"unused_depths_cleared", session.depthsCleared()},
            {"errors_of_the_program", session.errorsOfProgram()},
            {"own_seconds",
             {{"frames", session.spent().frames}, {"sum", session.spent().seconds}, {"most", session.spent().most}}}};
}

std::string ways(std::uint32_t via) {
    std::string text;
    text += (via & SLUICE_INJECT_VIA_GET_PROC_ADDRESS) != 0 ? "GetProcAddress " : "";
    text += (via & SLUICE_INJECT_VIA_DLSYM) != 0 ? "dlsym " : "";
    return text.empty() ? "symbol" : text.substr(0, text.size() - 1);
}

}  // namespace

std::string contextText(Session& session) {
    return sessionJson(session).dump(1, ' ', false, Json::error_handler_t::replace);
}

std::string reportText(const Payload& payload, const std::vector<std::string>& contexts,
                       std::uint64_t other_drawables) {
    Json hooks = Json::array();
    for (std::uint32_t i = 0; i < payload.shim->hook_count; ++i) {
        const SluiceInjectHook& hook = payload.shim->hooks[i];
        if (hook.calls > 0) {
            hooks.push_back({{"name", hook.name}, {"calls", hook.calls}, {"by", ways(hook.via)}});
        }
    }
    return fmt::format(
        "{{\n\"process\": {},\n\"contexts\": [{}],\n\"swaps_of_other_drawables\": {},\n\"hooks\": {}\n}}\n", ::getpid(),
        fmt::join(contexts, ",\n"), other_drawables, hooks.dump(1, ' ', false, Json::error_handler_t::replace));
}

void writeReport(const std::string& folder, const std::string& text) {
    const std::string path = fmt::format("{}/{}.json", folder, ::getpid());
    const std::string unfinished = path + ".part";
    {
        std::ofstream out(unfinished, std::ios::binary | std::ios::trunc);
        out << text;
        if (!out.flush()) {
            return;  // the folder is gone with the launcher: nobody will read it
        }
    }
    (void)std::rename(unfinished.c_str(), path.c_str());
}

}  // namespace sluice::inject
