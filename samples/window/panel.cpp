// SPDX-License-Identifier: MIT
#include "panel.hpp"

#include <backends/imgui_impl_opengl2.h>
#include <imgui.h>
#if __has_include(<backends/imgui_impl_sdl2.h>)
#include <backends/imgui_impl_sdl2.h>
#else
#include <backends/imgui_impl_sdl.h>  // as Debian 12 calls it
#endif

#include <algorithm>
#include <array>

namespace window {
namespace {

constexpr Uint32 kShownFor = 500;
constexpr float kWidth = 228.0F;

bool slider(const char* label, float& value, float low, float high, const char* format = "%.2f",
            ImGuiSliderFlags flags = 0) {
    return ImGui::SliderFloat(label, &value, low, high, format, flags | ImGuiSliderFlags_AlwaysClamp);
}

void count(const char* label, std::uint32_t& value, int low, int high) {
    int shown = static_cast<int>(value);
    if (ImGui::SliderInt(label, &shown, low, high)) {
        value = static_cast<std::uint32_t>(std::clamp(shown, low, high));
    }
}

void toggle(const char* label, std::uint32_t& value) {
    bool on = value != 0;
    if (ImGui::Checkbox(label, &on)) {
        value = on ? 1 : 0;
    }
}

void run(Controls& controls) {
    if (ImGui::Button(controls.paused ? "Go on" : "Pause")) {
        controls.paused = !controls.paused;
    }
    ImGui::SameLine();
    controls.step |= ImGui::Button("Step");
    ImGui::SameLine();
    controls.restart |= ImGui::Button("Reset");
    ImGui::SameLine();
    controls.screenshot |= ImGui::Button("Picture");
}

void views(SluiceFluid& look) {
    constexpr std::array<std::pair<const char*, std::uint32_t>, 4> kViews{{{"fluid", SLUICE_VIEW_FLUID},
                                                                           {"depth", SLUICE_VIEW_DEPTH},
                                                                           {"normal", SLUICE_VIEW_NORMAL},
                                                                           {"thickness", SLUICE_VIEW_THICKNESS}}};
    for (std::size_t i = 0; i < kViews.size(); ++i) {
        const auto& [name, view] = kViews[i];
        if (ImGui::RadioButton(name, look.view == view)) {
            look.view = view;
        }
        if (i % 2 == 0) {
            ImGui::SameLine(0.5F * kWidth);
        }
    }
}

void flow(FluidSettings& settings, Controls& controls) {
    slider("gravity", settings.flow.gravity[1], -20.0F, 5.0F, "%.1f m/s2");
    slider("viscosity", settings.flow.viscosity, 0.0F, 1.0F);
    slider("vorticity", settings.flow.vorticity, 0.0F, 1.0F);
    slider("tension", settings.flow.tension, 0.0F, 4.0F, "%.1f m/s2");
    count("solver", settings.flow.iterations, 1, 16);
    slider("jet width", settings.jet_width, 0.05F, 0.6F, "%.2f m");
    slider("jet speed", settings.jet_speed, 0.5F, 5.0F, "%.1f m/s");
    slider("particle", settings.radius, 0.03F, 0.15F, "r %.3f m");
    if (ImGui::IsItemDeactivatedAfterEdit()) {
        controls.restart = true;  // the size of a particle is for good
    }
}

void look(SluiceFluid& look) {
    constexpr float kDensest = 10.0F;
    ImGui::DragFloat3("absorb", &look.absorption[0], 0.02F, 0.0F, kDensest, "%.2f");
    ImGui::ColorEdit3("scatter", &look.scatter_colour[0], ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs);
    ImGui::SameLine();
    toggle("refract", look.refraction);
    ImGui::SameLine();
    toggle("reflect", look.reflection);
    slider("index", look.index_of_refraction, 1.01F, 2.0F);
    slider("highlight", look.specular_power, 10.0F, 4000.0F, "%.0f", ImGuiSliderFlags_Logarithmic);
    slider("splat", look.splat_radius, 0.5F, 3.0F, "%.2f r");
}

void filter(SluiceFluid& look) {
    bool on = look.filter != SLUICE_FILTER_NONE;
    if (ImGui::Checkbox("narrow range", &on)) {
        look.filter = on ? SLUICE_FILTER_NARROW_RANGE : SLUICE_FILTER_NONE;
    }
    count("passes", look.filter_iterations, 0, 8);
    slider("range", look.filter_range, 1.0F, 30.0F, "%.1f r");
    slider("clamp", look.filter_clamp, 0.1F, 5.0F, "%.1f r");
    slider("sigma", look.filter_sigma, 0.2F, 5.0F, "%.1f r");
    count("max pixels", look.filter_max_pixels, 1, 128);
    slider("blur", look.thickness_blur, 0.0F, 5.0F, "%.1f r");
    for (const auto& [name, scale] : {std::pair{"1/1", 1.0F}, {"1/2", 0.5F}, {"1/4", 0.25F}}) {
        if (ImGui::RadioButton(name, look.thickness_scale == scale)) {
            look.thickness_scale = scale;
        }
        ImGui::SameLine();
    }
    ImGui::TextUnformatted("thickness");
}

const char* nameOfTimeline(std::uint32_t timeline) {
    switch (timeline) {
        case SLUICE_TIMELINE_NATIVE:
            return "native";
        case SLUICE_TIMELINE_BINARY:
            return "binary";
        case SLUICE_TIMELINE_BRIDGED:
            return "bridged";
        case SLUICE_TIMELINE_FINISH:
            return "finish";
        default:
            return "none";
    }
}

void figures(const SluiceStatistics& s, const FrameTimes& times) {
    ImGui::Text("frame       %7.1f ms", times.frame_seconds * 1e3);
    ImGui::Text("fluid's end %7.1f ms", s.end_frame_seconds * 1e3);
    ImGui::Text("  waiting   %7.1f ms", s.wait_seconds * 1e3);
    ImGui::Text("simulation  %7.1f ms", s.last_simulation_seconds * 1e3);
    ImGui::Text("particles   %7u", s.particles);
    ImGui::Text("steps       %7llu", static_cast<unsigned long long>(s.steps));
    ImGui::Text("CPU copies  %7llu B", static_cast<unsigned long long>(s.cpu_copy_bytes + s.upload_bytes));
    ImGui::Text("%ux%u, timeline %s", s.width, s.height, nameOfTimeline(s.timeline));
    if (s.frames_without > 0 || s.renderers > 1) {
        ImGui::Text("%llu frames without, %u renderers", static_cast<unsigned long long>(s.frames_without),
                    s.renderers);
    }
    ImGui::TextWrapped("%s", &s.device[0]);
}

void passes(const SluiceStatistics& s) {
    for (std::uint32_t i = 0; i < std::min(s.pass_count, SLUICE_MAX_PASSES); ++i) {
        const SluicePassStats& pass = s.passes[i];
        ImGui::Text("%-16.16s%7.2f ms", &pass.name[0], static_cast<double>(pass.nanoseconds) * 1e-6);
    }
}

}  // namespace

Panel::Panel(SDL_Window* window, SDL_GLContext context) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // it leaves no file behind
    ImGui::StyleColorsDark();
    ImGui_ImplSDL2_InitForOpenGL(window, context);
    ImGui_ImplOpenGL2_Init();
}

Panel::~Panel() {
    ImGui_ImplOpenGL2_Shutdown();
    ImGui_ImplSDL2_Shutdown();
    ImGui::DestroyContext();
}

void Panel::hear(const SDL_Event& event) {
    ImGui_ImplSDL2_ProcessEvent(&event);
}

bool Panel::takesMouse() {
    return ImGui::GetIO().WantCaptureMouse;
}

bool Panel::takesKeys() {
    return ImGui::GetIO().WantTextInput;
}

void Panel::draw(Fluid& fluid, Controls& controls, const FrameTimes& times) {
    if (const Uint32 now = SDL_GetTicks(); shown_at_ == 0 || now - shown_at_ > kShownFor) {
        shown_ = fluid.statistics();
        shown_at_ = std::max(now, 1U);
    }
    ImGui_ImplOpenGL2_NewFrame();
    ImGui_ImplSDL2_NewFrame();
    ImGui::NewFrame();
    if (controls.panel) {
        const float room = ImGui::GetIO().DisplaySize.y - 8.0F;
        ImGui::SetNextWindowPos({4.0F, 4.0F}, ImGuiCond_Always);
        ImGui::SetNextWindowSizeConstraints({kWidth, 0.0F}, {kWidth, room});
        ImGui::SetNextWindowBgAlpha(0.8F);
        ImGui::Begin("Sluice", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
        ImGui::PushItemWidth(0.56F * kWidth);
        run(controls);
        views(fluid.settings.look);
        if (!fluid.trouble().empty()) {
            ImGui::TextWrapped("%s", fluid.trouble().c_str());
        }
        if (ImGui::CollapsingHeader("Figures", ImGuiTreeNodeFlags_DefaultOpen)) {
            figures(shown_, times);
        }
        if (ImGui::CollapsingHeader("Flow", ImGuiTreeNodeFlags_DefaultOpen)) {
            flow(fluid.settings, controls);
        }
        if (ImGui::CollapsingHeader("Look")) {
            look(fluid.settings.look);
        }
        if (ImGui::CollapsingHeader("Filter")) {
            filter(fluid.settings.look);
        }
        if (ImGui::CollapsingHeader("Passes")) {
            passes(shown_);
        }
        ImGui::PopItemWidth();
        ImGui::End();
    }
    ImGui::Render();
    ImGui_ImplOpenGL2_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace window
