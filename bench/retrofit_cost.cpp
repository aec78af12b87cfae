// SPDX-License-Identifier: MIT
// What libsluice.so costs an engine: frames without Sluice, with it and no fluid, and with fluid in each process with
// each timeline, in turns, in one run. Prints a table in Markdown, of medians as multiples of the first row.
//   retrofit_cost [FRAMES [WIDTH HEIGHT]]
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "sluice/host_gl/context.hpp"
#include "sluice/host_gl/engine.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/sluice.h"

namespace {

using namespace sluice;
using Clock = std::chrono::steady_clock;

[[noreturn]] void stop(const char* text) {
    (void)std::fprintf(stderr, "retrofit_cost: %s\n", text);
    std::exit(3);
}

template <typename T>
T must(Result<T> result) {
    if (!result) {
        stop(result.error().message().c_str());
    }
    return std::move(result).value();
}

struct Row {
    const char* name;
    bool made, poured;
    std::uint32_t process, timeline;
    Sluice* fluid = nullptr;
    std::vector<double> frame{}, end{};  ///< milliseconds
};

constexpr std::array<float, 16> kView{1, 0, 0, 0, 0, 0.94F, 0.34F, 0, 0, -0.34F, 0.94F, 0, 0, -0.9F, -4.5F, 1};

std::array<float, 16> projection(float aspect) {
    constexpr float kNear = 0.1F;
    constexpr float kFar = 60.0F;
    return {2.0F / aspect,
            0,
            0,
            0,
            0,
            2.0F,
            0,
            0,
            0,
            0,
            (kFar + kNear) / (kNear - kFar),
            -1,
            0,
            0,
            2.0F * kFar * kNear / (kNear - kFar),
            0};
}

void makeSluice(Row& row, std::uint32_t width, std::uint32_t height) {
    SluiceOptions options{};
    sluice_options_defaults(&options, sizeof(options));
    options.width = width;
    options.height = height;
    options.process = row.process;
    options.timeline = row.timeline;
    if (sluice_create(&options, &row.fluid) != SLUICE_OK) {
        stop(sluice_last_error(nullptr));
    }
    if (!row.poured) {
        return;
    }
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    SluiceBlock block{};
    for (const std::size_t axis : {0U, 1U, 2U}) {
        block.low[axis] = water.low[axis];
        block.high[axis] = water.high[axis];
    }
    block.high[1] = 0.6F;  // at rest from the beginning: every frame costs the same
    water.blocks = &block;
    water.block_count = 1;
    if (sluice_set_water(row.fluid, &water) != SLUICE_OK) {
        stop(sluice_last_error(row.fluid));
    }
}

double milliseconds(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void frame(Row& row, int number, const host::LegacyEngine& engine, const SluiceCamera& camera) {
    const Clock::time_point begin = Clock::now();
    if (row.made) {
        (void)sluice_begin_frame(row.fluid, camera.view, camera.projection, number / 60.0);
    }
    engine.draw(camera, SluiceSky{});
    glFlush();
    const Clock::time_point end = Clock::now();
    if (row.made && sluice_end_frame(row.fluid) != SLUICE_OK) {
        stop(sluice_last_error(row.fluid));
    }
    row.end.push_back(milliseconds(end));
    glFinish();
    row.frame.push_back(milliseconds(begin));
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
    const int frames = argc > 1 ? std::atoi(argv[1]) : 60;
    const auto width = static_cast<std::uint32_t>(argc > 3 ? std::atoi(argv[2]) : 640);
    const auto height = static_cast<std::uint32_t>(argc > 3 ? std::atoi(argv[3]) : 480);
    const host::GlContext context = must(host::GlContext::create());
    if (const Status status = context.makeCurrent(); !status) {
        stop(status.error().message().c_str());
    }
    const host::Screen screen = must(host::Screen::create(width, height));
    host::EngineScene scene;
    scene.pillars.push_back({{2, 0, -2}, 0.3F, 2.5F});
    const host::LegacyEngine engine = must(host::LegacyEngine::create(scene));
    screen.bind();
    SluiceCamera camera{};
    std::copy(kView.begin(), kView.end(), camera.view);
    const auto seen = projection(static_cast<float>(width) / static_cast<float>(height));
    std::copy(seen.begin(), seen.end(), camera.projection);
    std::array<Row, 6> rows{{{"the engine alone", false, false, 0, 0},
                             {"Sluice, no fluid", true, false, SLUICE_PROCESS_OWN, SLUICE_TIMELINE_AUTO},
                             {"fluid, same process, bridged", true, true, SLUICE_PROCESS_SAME, SLUICE_TIMELINE_BRIDGED},
                             {"fluid, same process, finish", true, true, SLUICE_PROCESS_SAME, SLUICE_TIMELINE_FINISH},
                             {"fluid, own process, bridged", true, true, SLUICE_PROCESS_OWN, SLUICE_TIMELINE_BRIDGED},
                             {"fluid, own process, finish", true, true, SLUICE_PROCESS_OWN, SLUICE_TIMELINE_FINISH}}};
    for (Row& row : rows) {
        if (row.made) {
            makeSluice(row, width, height);
        }
        for (int i = 0; i < 3; ++i) {  // what is compiled when it is first used
            frame(row, i, engine, camera);
        }
        row.frame.clear();
        row.end.clear();
    }
    for (int i = 0; i < frames; ++i) {
        for (Row& row : rows) {
            frame(row, 3 + i, engine, camera);
        }
    }
    fmt::print("{}x{}, {} frames each, in turns, medians\n\n| what | frame | end_frame |\n| --- | ---: | ---: |\n",
               width, height, frames);
    for (const Row& row : rows) {
        fmt::print("| {} | {:.2f} | {:.2f} |\n", row.name, median(row.frame) / median(rows[0].frame),
                   median(row.end) / median(rows[0].frame));
    }
    for (const Row& row : rows) {
        sluice_destroy(row.fluid);
    }
    return 0;
}
