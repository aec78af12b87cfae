// SPDX-License-Identifier: MIT
#include "app/simulate_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "app/commands.hpp"
#include "app/parse_values.hpp"

namespace sluice::cli {

void addSimulateCommand(CLI::App& app, SimulateOptions& options, int& verbosity, std::function<int()>& run) {
    SimulateOptions& o = options;
    CLI::App& c = *app.add_subcommand("simulate", "Simulate a scene's fluid and write its particles");
    c.add_option("SCENE", o.scene, "scene file with a \"simulation\" (docs/cli.md)")->required()->type_name("");
    c.add_option("-o,--output", o.output, ".pos, .ply or .bgeo to write; #### or %04d stands\nfor the frame's number")
        ->required()
        ->type_name("FILE");
    c.add_option_function<std::string>(
         "--frames",
         [&o](const std::string& text) {
             const Result<scene::FrameRange> frames = parseFrameRange(text);
             if (!frames) {
                 throw CLI::ValidationError(frames.error().message());
             }
             o.frames = frames.value();
         },
         "frames to write instead of the scene's; those\nbefore them are simulated and not written")
        ->type_name("A..B");
    c.add_option("--seed", o.seed, fmt::format("seed of the start; {} if not given", o.seed))->type_name("N");
    auto* json = c.add_flag("--json", o.json, "summary as JSON on stdout");
    c.add_flag("-q,--quiet", o.quiet, "nothing but errors; not with --json")->excludes(json);
    c.add_flag("--validation", o.validation, "run under the Vulkan validation layer; exit\ncode 3 if it speaks");
    c.add_flag("-v,--verbose", verbosity, "more log lines on stderr; twice for all of them");
    c.footer(
        "Frame 1 is the start: the scene's boxes of fluid, and the particles of the file\n"
        "that its simulation.start names (.pos, .ply or .bgeo). With \"collide\": \"depth\"\n"
        "the fluid meets what an EXR of depths shows (simulation.depth.path), as render\n"
        "--layers writes one. Bodies are written beside the particles of each frame,\n"
        "dam_0001.bodies.json beside dam_0001.pos.\n"
        "The same scene and seed give the same bits on the same\n"
        "device; the replay hash at the end tells whether they did.\n"
        "Example:\n  sluice simulate samples/dam_break.json -o dam_####.pos --frames 1..30\n\n"
        "Exit codes of simulate:\n"
        "  0    done\n"
        "  1    the command line is wrong\n"
        "  2    the scene is missing or wrong, or has no fluid: nothing was written\n"
        "  3    no Vulkan device, or the fluid could not go on: the frames before stay;\n"
        "       or --validation had something to say\n"
        "  4    not enough memory, an output that cannot be written, or an internal\n"
        "       fault\n"
        "  130  interrupted (SIGINT or SIGTERM), within a frame, too: the frames\n"
        "       before stay\n");
    c.callback([&o, &run] { run = [&o] { return simulate(o); }; });
}

}  // namespace sluice::cli
