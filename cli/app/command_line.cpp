// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <string>

#include "app/commands.hpp"
#include "app/log.hpp"
#include "app/parse_values.hpp"
#include "sluice/format.hpp"

namespace sluice::cli {
namespace {

constexpr const char* kExitCodes =
    "Exit codes:\n"
    "  0    done\n"
    "  1    the command line is wrong\n"
    "  2    an input file is missing or wrong; no output was written for it\n"
    "  3    the renderer is missing or failed, or nothing can be shared here: the\n"
    "       host's own frames were still written, without fluid; or --validation\n"
    "       had something to say\n"
    "  4    no OpenGL, not enough memory, an output that cannot be written, or an\n"
    "       internal fault\n"
    "  130  interrupted; the file in hand was finished\n";

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

/// The numbers that --timeline, --depth-format and --view stand for.
const std::map<std::string, SluiceTimelineKind> kTimelines{{"auto", SLUICE_TIMELINE_AUTO},
                                                           {"native", SLUICE_TIMELINE_NATIVE},
                                                           {"binary", SLUICE_TIMELINE_BINARY},
                                                           {"bridged", SLUICE_TIMELINE_BRIDGED},
                                                           {"finish", SLUICE_TIMELINE_FINISH}};
const std::map<std::string, SluiceFormat> kDepthFormats{
    {"auto", SLUICE_FORMAT_NONE}, {"D32F", SLUICE_FORMAT_D32F}, {"R32F", SLUICE_FORMAT_R32F}};
const std::map<std::string, std::uint32_t> kViewNames{{"fluid", SLUICE_VIEW_FLUID},
                                                      {"depth", SLUICE_VIEW_DEPTH},
                                                      {"normal", SLUICE_VIEW_NORMAL},
                                                      {"thickness", SLUICE_VIEW_THICKNESS}};

/// What every command line can hold.
struct Line {
    CLI::App app{"Sluice: Vulkan fluid in an OpenGL engine's frame."};
    RenderOptions render;
    ProbeOptions probe;
    ExplainOptions explain;
    GenerateOptions generate;
    ConvertOptions convert;
    int verbosity = 0;
    std::function<int()> run;
};

void addVerbosity(CLI::App& command, Line& line) {
    command.add_flag("-v,--verbose", line.verbosity, "More log lines on stderr; twice for all of them");
}

void addRender(Line& line) {
    RenderOptions& o = line.render;
    CLI::App& c = *line.app.add_subcommand("render", "Render a scene's frames through both APIs");
    c.add_option("scene", o.scene, "Scene file (JSON; docs/cli.md has the schema)")->required();
    c.add_option("-o,--output", o.output, "PNG to write; #### or %04d stands for the frame's number")->required();
    c.add_option_function<std::string>("--frames", into(o.frames, parseFrameRange),
                                       "Frames A..B instead of the scene's")
        ->type_name("A..B");
    c.add_option_function<std::string>("--size", into(o.size, parseSize), "Picture size instead of the scene's")
        ->type_name("WxH");
    c.add_option("--particles", o.particles, "Particle file or numbered sequence instead of the scene's")
        ->type_name("FILE");
    c.add_option("--layers", o.layers, "EXR with every layer: beauty, host, fluid, normal, thickness; numbered like -o")
        ->type_name("EXR");
    c.add_option("--trace", o.trace, "Chrome trace of every signal, wait and pass (opens in Perfetto)")
        ->type_name("JSON");
    c.add_flag("--json", o.json, "Summary as JSON on stdout");
    c.add_flag("-q,--quiet", o.quiet, "Print nothing but errors")->excludes("--json");
    c.add_option("--plugin", o.plugin, "Renderer plugin instead of the one found")->type_name("PATH");
    c.add_option("--timeline", o.timeline,
                 "How the two APIs wait for each other: auto, native, binary, bridged, finish")
        ->transform(CLI::CheckedTransformer(kTimelines))
        ->type_name("KIND");
    c.add_option("--depth-format", o.depth_format, "Shared depth: auto, D32F, R32F")
        ->transform(CLI::CheckedTransformer(kDepthFormats))
        ->type_name("FORMAT");
    c.add_option("--image-sets", o.image_sets, "Sets of shared images in the ring")
        ->check(CLI::Range(1U, SLUICE_MAX_IMAGE_SETS))
        ->capture_default_str();
    c.add_option("--view", o.view, "What to show: fluid, depth, normal, thickness")
        ->transform(CLI::CheckedTransformer(kViewNames))
        ->type_name("VIEW");
    c.add_flag("--no-fluid", o.no_fluid, "The host's frame alone");
    c.add_flag("--validation", o.validation, "Run under the Vulkan validation layer; exit code 3 if it speaks");
    addVerbosity(c, line);
    c.footer(std::string("A particle file may be .pos, .ply or .bgeo. Every input is checked before the first file is\n"
                         "written, and files appear whole or not at all.\n\n") +
             kExitCodes);
    c.callback([&line] { line.run = [&line] { return render(line.render); }; });
}

void addProbe(Line& line) {
    CLI::App& c = *line.app.add_subcommand("probe", "Print what this machine's OpenGL and Vulkan can share");
    c.add_flag("--json", line.probe.json, "As JSON");
    c.add_option("--plugin", line.probe.plugin, "Renderer plugin instead of the one found")->type_name("PATH");
    c.add_flag("--validation", line.probe.validation, "Run under the Vulkan validation layer");
    addVerbosity(c, line);
    c.footer("Every format makes a canary round trip at two odd sizes. Exit code 0 if sharing is possible, 3 if not.");
    c.callback([&line] { line.run = [&line] { return probe(line.probe); }; });
}

void addExplain(Line& line) {
    ExplainOptions& o = line.explain;
    CLI::App& c = *line.app.add_subcommand("explain", "Print the passes that a scene needs, and why");
    c.add_option("scene", o.scene, "Scene file")->required();
    c.add_option("--particles", o.particles, "Particle file instead of the scene's")->type_name("FILE");
    c.add_option_function<std::string>("--size", into(o.size, parseSize), "Picture size instead of the scene's")
        ->type_name("WxH");
    c.add_flag("--layers", o.layers, "As if normals and thickness were written too");
    c.add_option("--plugin", o.plugin, "Renderer plugin instead of the one found")->type_name("PATH");
    c.add_flag("--json", o.json, "As JSON");
    addVerbosity(c, line);
    c.callback([&line] { line.run = [&line] { return explain(line.explain); }; });
}

void addGenerate(Line& line) {
    GenerateOptions& o = line.generate;
    CLI::App& c = *line.app.add_subcommand("generate", "Make particle files");
    CLI::App& pool =
        *c.add_subcommand("pool", "A wavy pool and a ball of liquid that falls into it, 30 frames a second");
    pool.add_option("--particles", o.particles, "About how many")->capture_default_str();
    pool.add_option("--seed", o.seed, "Seed of the jitter")->capture_default_str();
    pool.add_option_function<std::string>("--frames", into(o.frames, parseFrameRange), "Frames A..B; frame 1 is time 0")
        ->type_name("A..B");
    pool.add_option("-o,--output", o.output, "File to write (.pos, .ply, .bgeo); #### stands for the frame's number")
        ->required();
    pool.add_flag("-q,--quiet", o.quiet, "Print nothing but errors");
    c.require_subcommand(1);
    pool.callback([&line] { line.run = [&line] { return generate(line.generate); }; });
}

void addConvert(Line& line) {
    ConvertOptions& o = line.convert;
    CLI::App& c = *line.app.add_subcommand("convert", "Convert a particle file (.pos, .ply, .bgeo) by ending");
    c.add_option("input", o.input, "File to read")->required();
    c.add_option("output", o.output, "File to write")->required();
    c.add_option("--radius", o.radius, "Particle radius in metres for an input that carries none")
        ->check(CLI::PositiveNumber);
    c.callback([&line] { line.run = [&line] { return convert(line.convert); }; });
}

int parseAndRun(int argc, const char* const* argv) {
    Line line;
    line.app.set_version_flag("--version", "sluice " SLUICE_VERSION);
    line.app.require_subcommand(1);
    line.app.footer(std::string(kExamples) + "\n" + kExitCodes);
    addRender(line);
    addProbe(line);
    addExplain(line);
    addGenerate(line);
    addConvert(line);
    try {
        line.app.parse(argc, argv);
    } catch (const CLI::ParseError& stop) {
        // --help and --version stop with success; everything else is a usage error whatever CLI11 numbers it.
        return line.app.exit(stop) == 0 ? kExitOk : kExitUsage;
    }
    startLog(line.verbosity, line.render.quiet || line.generate.quiet);
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
