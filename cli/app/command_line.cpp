// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "app/commands.hpp"
#include "app/help.hpp"
#include "app/inject.hpp"
#include "app/ledger_commands.hpp"
#include "app/log.hpp"
#include "app/parse_values.hpp"
#include "app/simulate_command.hpp"
#include "app/stress_command.hpp"

namespace sluice::cli {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  sluice generate pool --particles 100000 -o pool.pos\n"
    "  sluice render samples/still.json --particles pool.pos -o pool.png\n"
    "  sluice generate pool --frames 1..60 -o samples/particles/pool_####.pos\n"
    "  sluice render samples/courtyard.json -o out_####.png --frames 1..60 \\\n"
    "      --layers out_####.exr --trace out.json\n"
    "  sluice probe\n"
    "  sluice explain samples/still.json --particles pool.pos\n";

/// Turns a Result-parser into the callback of an option; a bad value becomes a usage error.
template <typename T, typename Parse>
std::function<void(const std::string&)> into(T& out, Parse parse) {
    return [&out, parse](const std::string& text) {
        auto value = parse(text);
        if (!value) {
            throw CLI::ValidationError(value.error().message());
        }
        out = value.value();
    };
}

constexpr std::array<std::pair<std::string_view, SluiceTimelineKind>, 5> kTimelines{
    {{"auto", SLUICE_TIMELINE_AUTO},
     {"native", SLUICE_TIMELINE_NATIVE},
     {"binary", SLUICE_TIMELINE_BINARY},
     {"bridged", SLUICE_TIMELINE_BRIDGED},
     {"finish", SLUICE_TIMELINE_FINISH}}};
constexpr std::array<std::pair<std::string_view, SluiceFormat>, 3> kDepthFormats{
    {{"auto", SLUICE_FORMAT_NONE}, {"D32F", SLUICE_FORMAT_D32F}, {"R32F", SLUICE_FORMAT_R32F}}};
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 4> kViewNames{{{"fluid", SLUICE_VIEW_FLUID},
                                                                                {"depth", SLUICE_VIEW_DEPTH},
                                                                                {"normal", SLUICE_VIEW_NORMAL},
                                                                                {"thickness", SLUICE_VIEW_THICKNESS}}};

/// A parser of one of `names`.
template <typename T, std::size_t N>
auto oneOf(const char* what, const std::array<std::pair<std::string_view, T>, N>& names) {
    return [what, &names](const std::string& text) -> Result<T> {
        std::string expected;
        for (const auto& [name, value] : names) {
            if (name == text) {
                return value;
            }
            expected += (expected.empty() ? "" : ", ") + std::string(name);
        }
        return badValue(what, "one of " + expected, text);
    };
}

/// A parser of a number without a sign, which CLI11 would wrap round.
auto wholeNumber(const char* what) {
    return [what](const std::string& text) { return parseWhole(what, text); };
}

/// What every command line can hold.
struct Line {
    CLI::App app{"Sluice: Vulkan fluid in an OpenGL engine's frame."};
    RenderOptions render;
    ProbeOptions probe;
    ExplainOptions explain;
    GenerateOptions generate;
    ConvertOptions convert;
    LedgerCommands ledger;
    SimulateOptions simulate;
    stress::Options stress;
    InjectOptions inject;
    int verbosity = 0;
    std::function<int()> run;
};

void addVerbosity(CLI::App& command, Line& line) {
    command.add_flag("-v,--verbose", line.verbosity, "more log lines on stderr; twice for all of them");
}

constexpr const char* kSizeHelp = "picture size instead of the scene's";
constexpr const char* kParticlesHelp = "particle file instead of the scene's";
constexpr const char* kPluginHelp = "renderer plugin instead of the one found";

void addRender(Line& line) {
    RenderOptions& o = line.render;
    CLI::App& c = *line.app.add_subcommand("render", "Render a scene's frames through both APIs");
    c.add_option("SCENE", o.scene, "scene file (JSON; docs/cli.md has the schema)")->required()->type_name("");
    c.add_option("-o,--output", o.output, "picture to write; #### or %04d stands for the\nframe's number")
        ->required()
        ->type_name("PNG");
    c.add_option_function<std::string>("--frames", into(o.frames, parseFrameRange), "frames instead of the scene's")
        ->type_name("A..B");
    c.add_option_function<std::string>("--size", into(o.size, parseSize), kSizeHelp)->type_name("WxH");
    c.add_option("--particles", o.particles, "particle file or numbered sequence instead of\nthe scene's")
        ->type_name("FILE");
    c.add_option("--layers", o.layers, "picture, host, fluid, normal and thickness as\nlayers; numbered like -o")
        ->type_name("EXR");
    c.add_option("--trace", o.trace, "Chrome trace of every signal, wait and pass\n(opens in Perfetto)")
        ->type_name("JSON");
    auto* json = c.add_flag("--json", o.json, "summary as JSON on stdout");
    c.add_flag("-q,--quiet", o.quiet, "nothing but errors; not with --json")->excludes(json);
    c.add_option("--plugin", o.plugin, kPluginHelp)->type_name("PATH");
    c.add_option_function<std::string>("--timeline", into(o.timeline, oneOf("--timeline", kTimelines)),
                                       "how the two APIs wait for each other: auto,\nnative, binary, bridged or finish")
        ->type_name("KIND");
    c.add_option_function<std::string>("--depth-format", into(o.depth_format, oneOf("--depth-format", kDepthFormats)),
                                       "format of the shared depth: auto, D32F or R32F")
        ->type_name("FORMAT");
    c.add_option_function<std::string>("--image-sets", into(o.image_sets, parseImageSets),
                                       fmt::format("sets of shared images in the ring, 1 to {};\n{} if not given",
                                                   SLUICE_MAX_IMAGE_SETS, o.image_sets))
        ->type_name("N");
    c.add_option_function<std::string>("--frames-in-flight", into(o.frames_in_flight, parseFramesInFlight),
                                       "how far a simulation may run ahead of the\npictures, 1 to 3; 1 if not given")
        ->type_name("N");
    c.add_option_function<std::string>("--seed", into(o.seed, wholeNumber("--seed")),
                                       "seed of a simulation's start; 1 if not given")
        ->type_name("N");
    c.add_option_function<std::string>("--view", into(o.view, oneOf("--view", kViewNames)),
                                       "what to show: fluid, depth, normal or\nthickness")
        ->type_name("VIEW");
    auto* no_fluid = c.add_flag("--no-fluid", o.no_fluid, "the host's frame alone");
    c.add_flag("--isolate", o.isolate, "run the renderer in a process of its own")->excludes(no_fluid);
    c.add_flag("--validation", o.validation, "run under the Vulkan validation layer; exit\ncode 3 if it speaks");
    c.add_flag("--ledger", o.ledger,
               "check the order of every signal, wait and access\nwhile it happens, and report findings");
    c.add_option("--ledger-log", o.ledger_log, "the same, and write the log for sluice diagnose")->type_name("FILE");
    c.add_option_function<std::string>(
         "--deadline", into(o.deadline_s, parseDeadline),
         "longest wait for the renderer before the frame\ngoes on without fluid; 10 if not given")
        ->type_name("SECONDS");
    c.add_option_function<std::string>(
         "--fault",
         [&o](const std::string& text) {
             namesHostFault(text) ? into(o.host_fault, parseHostFault)(text) : into(o.fault, parseFault)(text);
         },
         "for tests: let something go wrong in frame FRAME\n(docs/cli.md has the kinds)")
        ->excludes(no_fluid)
        ->type_name("KIND@FRAME");
    addVerbosity(c, line);
    c.footer(std::string("A particle file may be .pos, .ply or .bgeo; of a scene with bodies, its\n"
                         ".bodies.json lies beside it, as simulate writes it. A scene that names none and\n"
                         "has fluid is simulated while its frames are drawn; it may begin with a file,\n"
                         "simulation.start, and collide with the depth of its own pictures. Every input is\n"
                         "checked before the first file is written, and files appear whole or not at all.\n"
                         "\n") +
             exitCodesHelp());
    c.callback([&line] { line.run = [&line] { return render(line.render); }; });
}

void addProbe(Line& line) {
    CLI::App& c = *line.app.add_subcommand("probe", "Print what OpenGL and Vulkan can share here");
    c.add_flag("--json", line.probe.json, "as JSON");
    c.add_option("--plugin", line.probe.plugin, kPluginHelp)->type_name("PATH");
    c.add_flag("--validation", line.probe.validation, "run under the Vulkan validation layer");
    addVerbosity(c, line);
    c.footer(
        "Every format makes a canary round trip at two odd sizes.\n"
        "Exit code 0 if sharing is possible, 3 if not.\n");
    c.callback([&line] { line.run = [&line] { return probe(line.probe); }; });
}

void addExplain(Line& line) {
    ExplainOptions& o = line.explain;
    CLI::App& c = *line.app.add_subcommand("explain", "Print the passes that a scene needs, and why");
    c.add_option("SCENE", o.scene, "scene file")->required()->type_name("");
    c.add_option("--particles", o.particles, kParticlesHelp)->type_name("FILE");
    c.add_option_function<std::string>("--size", into(o.size, parseSize), kSizeHelp)->type_name("WxH");
    c.add_flag("--layers", o.layers, "as if normals and thickness were written too");
    c.add_option("--plugin", o.plugin, kPluginHelp)->type_name("PATH");
    c.add_flag("--json", o.json, "as JSON");
    addVerbosity(c, line);
    c.footer("Example:\n  sluice explain samples/still.json --particles pool.pos\n");
    c.callback([&line] { line.run = [&line] { return explain(line.explain); }; });
}

void addGenerate(Line& line) {
    GenerateOptions& o = line.generate;
    CLI::App& c = *line.app.add_subcommand("generate", "Make particle files");
    const std::string example = "Example:\n  sluice generate pool --particles 100000 -o pool.pos\n";
    c.footer(example);
    CLI::App& pool = *c.add_subcommand("pool", "A wavy pool and a ball of water that falls into it");
    pool.group("Commands");
    pool.add_option_function<std::string>("--particles", into(o.particles, wholeNumber("--particles")),
                                          fmt::format("about how many; {} if not given", o.particles))
        ->type_name("N");
    pool.add_option_function<std::string>("--seed", into(o.seed, wholeNumber("--seed")),
                                          fmt::format("seed of the jitter; {} if not given", o.seed))
        ->type_name("N");
    pool.add_option_function<std::string>("--frames", into(o.frames, parseFrameRange),
                                          "30 a second; frame 1 is time 0 and what is made\nif not given")
        ->type_name("A..B");
    pool.add_option("-o,--output", o.output,
                    ".pos, .ply or .bgeo to write; #### or %04d stands\nfor the frame's number")
        ->required()
        ->type_name("FILE");
    pool.add_flag("-q,--quiet", o.quiet, "nothing but errors");
    pool.footer(example + "  sluice generate pool --frames 1..60 -o pool_####.pos\n");
    c.require_subcommand(1);
    pool.callback([&line] { line.run = [&line] { return generate(line.generate); }; });
}

void addConvert(Line& line) {
    ConvertOptions& o = line.convert;
    CLI::App& c = *line.app.add_subcommand("convert", "Convert a particle file into another format");
    c.add_option("IN", o.input, "file to read: .pos, .ply or .bgeo")->required()->type_name("");
    c.add_option("OUT", o.output, "file to write; its ending decides the format")->required()->type_name("");
    c.add_option_function<std::string>("--radius", into(o.radius, parseRadius),
                                       "particle radius for an input that carries none")
        ->type_name("METRES");
    c.footer("Example:\n  sluice convert wave.ply wave.pos --radius 0.015\n");
    c.callback([&line] { line.run = [&line] { return convert(line.convert); }; });
}

/// The word that stands where a command must, if it is none.
std::string wrongCommand(const CLI::App& app, int argc, const char* const* argv) {
    const CLI::App* at = &app;
    for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
        const std::vector<const CLI::App*> commands = at->get_subcommands([](const CLI::App*) { return true; });
        if (commands.empty()) {
            break;
        }
        const auto found = std::find_if(commands.begin(), commands.end(),
                                        [&](const CLI::App* command) { return command->get_name() == argv[i]; });
        if (found == commands.end()) {
            return unknownCommand(*at, argv[i]);
        }
        at = *found;
    }
    return {};
}

int parseAndRun(int argc, const char* const* argv) {
    Line line;
    line.app.set_help_flag("-h,--help", "this page");
    line.app.set_version_flag("--version", "sluice " SLUICE_VERSION, "the version");
    line.app.require_subcommand(1);
    line.app.name("sluice");
    line.app.formatter(helpFormatter());
    line.app.footer(std::string(kExamples) + "\n" + exitCodesHelp());
    addRender(line);
    addProbe(line);
    addExplain(line);
    addGenerate(line);
    addConvert(line);
    addLedgerCommands(line.app, line.ledger, line.run);
    addSimulateCommand(line.app, line.simulate, line.verbosity, line.run);
    addStressCommand(line.app, line.stress, line.run);
    addInjectCommand(line.app, line.inject, line.run);
    for (CLI::App* command : line.app.get_subcommands(nullptr)) {
        command->group("Commands");
    }
    if (const std::string wrong = wrongCommand(line.app, argc, argv); !wrong.empty()) {
        (void)std::fputs(wrong.c_str(), stderr);
        return kExitUsage;
    }
    try {
        line.app.parse(argc, argv);
    } catch (const CLI::ParseError& stop) {
        // --help and --version stop with success; everything else is a usage error whatever CLI11 numbers it.
        if (stop.get_exit_code() == 0) {
            return line.app.exit(stop) == 0 ? kExitOk : kExitUsage;
        }
        (void)std::fputs(usageError(line.app, stop).c_str(), stderr);
        return kExitUsage;
    }
    startLog(line.verbosity,
             line.render.quiet || line.generate.quiet || line.simulate.quiet || line.ledger.diagnose.quiet);
    return line.run();
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) noexcept {
    try {
        return parseAndRun(argc, argv);
    } catch (const std::bad_alloc&) {
        (void)std::fputs("sluice: not enough memory (close other programs, or ask for less at once)\n", stderr);
    } catch (const std::exception& fault) {
        (void)std::fprintf(stderr, "sluice: internal fault: %s\n", fault.what());
    } catch (...) {
        (void)std::fputs("sluice: internal fault\n", stderr);
    }
    return kExitInternal;
}

}  // namespace sluice::cli
