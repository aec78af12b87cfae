// SPDX-License-Identifier: MIT
// What the ledger costs a frame: the same frames with it off, live, and live with a log, in turns, through the real
// drivers. Prints a Markdown table of medians and of ratios to "off".
//
// Usage: ledger_cost [ROUNDS]
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "sluice/format.hpp"
#include "sluice/host_gl/context.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "sluice/host_gl/plugin_library.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/ledger/live.hpp"
#include "sluice/trace.hpp"

#include <epoxy/gl.h>

namespace {

using namespace sluice;

constexpr std::array<const char*, 3> kModes{"off", "live", "logging"};
constexpr std::size_t kWarmUp = 20;

[[noreturn]] void fail(const Error& error) {
    fmt::print(stderr, "ledger_cost: {}\n", error.message());
    std::exit(1);
}

struct Workload {
    const char* name;
    std::uint32_t width, height;
    std::uint32_t view;
    std::size_t particles;
};

/// A host with or without a ledger, and what its frames took.
struct Candidate {
    std::unique_ptr<ledger::LiveLedger> ledger;
    std::unique_ptr<host::FluidHost> host;
    std::vector<double> ms;
};

host::FrameInput frameInput(std::uint32_t view) {
    host::FrameInput input;
    for (const std::size_t i : {std::size_t{0}, std::size_t{5}, std::size_t{10}, std::size_t{15}}) {
        input.camera.view[i] = 1.0F;
    }
    // 90 degrees, near 0.1 m, far 100 m.
    input.camera.projection[0] = input.camera.projection[5] = 1.0F;
    input.camera.projection[10] = -1.002002F;
    input.camera.projection[11] = -1.0F;
    input.camera.projection[14] = -0.2002002F;
    input.camera.near_plane = 0.1F;
    input.camera.far_plane = 100.0F;
    input.sky.to_sun[1] = 1.0F;
    input.fluid.index_of_refraction = 1.33F;
    input.fluid.specular_power = 100.0F;
    input.fluid.splat_radius = 1.5F;
    input.fluid.thickness_scale = 0.5F;
    input.fluid.view = view;
    return input;
}

/// A block of particles in front of the camera.
std::vector<float> block(std::size_t count) {
    std::vector<float> positions;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = i / 31 % 21;
        const std::size_t layer = i / 651;
        positions.push_back(-1.5F + 0.1F * static_cast<float>(i % 31));
        positions.push_back(-1.0F + 0.1F * static_cast<float>(row));
        positions.push_back(-2.0F - 0.1F * static_cast<float>(layer));
    }
    return positions;
}

Candidate make(const host::PluginLibrary& library, const Workload& work, SluiceTimelineKind timeline, std::size_t mode,
               const std::string& log_path) {
    Candidate made;
    if (mode > 0) {
        std::unique_ptr<ledger::LogWriter> log;
        if (mode == 2) {
            auto created = ledger::LogWriter::create(log_path);
            if (!created) {
                fail(created.error());
            }
            log = std::move(created).value();
        }
        made.ledger = std::make_unique<ledger::LiveLedger>(ledger::LedgerOptions{}, std::move(log));
    }
    host::FluidHostConfig config;
    config.width = work.width;
    config.height = work.height;
    config.timeline = timeline;
    config.ledger = made.ledger.get();
    auto host = host::FluidHost::create(library, config);
    if (!host) {
        fail(host.error());
    }
    made.host = std::move(host).value();
    if (work.particles > 0) {
        const std::vector<float> positions = block(work.particles);
        SluiceParticles particles{};
        particles.struct_size = sizeof(particles);
        particles.count = static_cast<std::uint32_t>(work.particles);
        particles.position = positions.data();
        particles.radius = 0.05F;
        if (Status status = made.host->setParticles(particles); !status) {
            fail(status.error());
        }
    }
    return made;
}

double frame(Candidate& one, const host::Screen& screen, const host::FrameInput& input) {
    const std::uint64_t begin = monotonicNanoseconds();
    Status status = one.host->submit(screen, input);
    if (status) {
        status = one.host->composite(screen);
    }
    if (!status) {
        fail(status.error());
    }
    glFinish();
    return static_cast<double>(monotonicNanoseconds() - begin) * 1e-6;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void measure(const host::PluginLibrary& library, const Workload& work, SluiceTimelineKind timeline,
             std::size_t rounds) {
    const std::string log_path =
        (std::filesystem::temp_directory_path() / fmt::format("ledger_cost_{}.log", getpid())).string();
    auto screen = host::Screen::create(work.width, work.height);
    if (!screen) {
        fail(screen.error());
    }
    std::vector<Candidate> all;
    for (std::size_t mode = 0; mode < kModes.size(); ++mode) {
        all.push_back(make(library, work, timeline, mode, log_path));
    }
    const host::FrameInput input = frameInput(work.view);
    for (std::size_t round = 0; round < rounds + kWarmUp; ++round) {
        for (std::size_t turn = 0; turn < all.size(); ++turn) {
            // Each goes first, second and third equally often.
            Candidate& one = all[(turn + round) % all.size()];
            const double ms = frame(one, screen.value(), input);
            if (round >= kWarmUp) {
                one.ms.push_back(ms);
            }
        }
    }
    const double off = median(all[0].ms);
    for (std::size_t mode = 0; mode < all.size(); ++mode) {
        Candidate& one = all[mode];
        // Of neighbours in time, because a machine changes its speed over minutes.
        std::vector<double> ratios;
        for (std::size_t i = 0; i < one.ms.size(); ++i) {
            ratios.push_back(one.ms[i] / all[0].ms[i]);
        }
        one.host.reset();
        std::string events = "-";
        if (one.ledger) {
            if (Status status = one.ledger->finish(ledger::End::Closed); !status) {
                fail(status.error());
            }
            events = fmt::format("{:.1f}",
                                 static_cast<double>(one.ledger->eventsSeen()) / static_cast<double>(rounds + kWarmUp));
            if (!one.ledger->findings().empty()) {
                fmt::print(stderr, "ledger_cost: a finding in clean frames: {}\n",
                           one.ledger->findings().front().sentence);
                std::exit(1);
            }
        }
        fmt::print("| {} | {} | {} | {} | {:.3f} | {:.3f} | {:.3f} |\n", work.name, toString(timeline), kModes.at(mode),
                   events, median(one.ms), median(one.ms) / off, median(ratios));
    }
    std::filesystem::remove(log_path);
}

}  // namespace

int main(int argc, char** argv) {
    const long asked = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 300;
    if (asked < 10 || asked > 1'000'000) {
        fmt::print(stderr, "ledger_cost: rounds: expected 10 to 1000000, found \"{}\"\n", argv[1]);
        return 1;
    }
    auto context = host::GlContext::create();
    if (!context) {
        fail(context.error());
    }
    if (Status status = context.value().makeCurrent(); !status) {
        fail(status.error());
    }
    auto library = host::PluginLibrary::load(SLUICE_REAL_RENDERER);
    if (!library) {
        fail(library.error());
    }
    fmt::print(
        "| frames | timeline | ledger | events a frame | median ms | ratio of medians | median of ratios |\n"
        "| --- | --- | --- | ---: | ---: | ---: | ---: |\n");
    constexpr std::array kWork{Workload{"echo 64x64", 64, 64, SLUICE_VIEW_ECHO, 0},
                               Workload{"fluid 640x360, 5,000 particles", 640, 360, SLUICE_VIEW_FLUID, 5'000}};
    for (const Workload& work : kWork) {
        for (const SluiceTimelineKind timeline : {SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH}) {
            measure(library.value(), work, timeline, static_cast<std::size_t>(asked));
        }
    }
    return 0;
}
