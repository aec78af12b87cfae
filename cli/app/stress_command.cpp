// SPDX-License-Identifier: MIT
#include "app/stress_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <limits>
#include <string>

#include "app/parse_values.hpp"

namespace sluice::cli {
namespace {

template <typename T, std::size_t N>
std::string listOf(const std::array<stress::Named<T>, N>& names) {
    std::string text;
    for (const auto& one : names) {
        text += std::string(one.name) + ", ";
    }
    return text + "all";
}

/// An option that takes one of `names`, or "all", which empties the choice.
template <typename T, std::size_t N>
void addChoice(CLI::App& app, const char* name, std::optional<T>& out, const std::array<stress::Named<T>, N>& names,
               const char* type, const char* help) {
    app.add_option_function<std::string>(
           name,
           [&out, &names, name](const std::string& text) {
               for (const auto& one : names) {
                   if (one.name == text) {
                       out = one.value;
                       return;
                   }
               }
               if (text != "all") {
                   throw CLI::ValidationError(badValue(name, "one of " + listOf(names), text).message());
               }
               out.reset();
           },
           help)
        ->type_name(type);
}

template <typename T>
void addNumber(CLI::App& app, const char* name, T& out, const char* expected, bool zero, const char* type,
               const char* help) {
    app.add_option_function<std::string>(
           name,
           [=, &out](const std::string& text) {
               double most = 1e6;
               std::uint64_t whole = 0;
               const char* const end = text.data() + text.size();
               if constexpr (std::is_same_v<T, std::optional<double>>) {
                   double value = 0.0;
                   const auto [stop, code] = std::from_chars(text.data(), end, value);
                   if (code == std::errc() && stop == end && value > 0.0 && value <= most) {
                       out = value;
                       return;
                   }
               } else {
                   const auto [stop, code] = std::from_chars(text.data(), end, whole);
                   if (code == std::errc() && stop == end && (zero || whole > 0)) {
                       out = whole;
                       return;
                   }
               }
               throw CLI::ValidationError(badValue(name, expected, text).message());
           },
           help)
        ->type_name(type);
}

}  // namespace

void addStressCommand(CLI::App& app, stress::Options& options, std::function<int()>& run) {
    stress::Options& o = options;
    CLI::App& c = *app.add_subcommand("stress", "Stress the hand-offs between OpenGL and Vulkan");
    addNumber(c, "--handoffs", o.handoffs, "a whole number above 0", false, "N",
              "hand-offs in all, shared out evenly over the\ncombinations; 20000 if not given");
    addNumber(c, "--seconds", o.seconds, "seconds above 0, at most 1000000", false, "S", "time in all, likewise");
    c.get_option("--seconds")->excludes(c.get_option("--handoffs"));
    addNumber(c, "--seed", o.seed, "a whole number", true, "N", "what follows from chance follows from this; 1");
    addChoice(c, "--pattern", o.pattern, stress::kPatterns, "NAME",
              "gl-to-vk, vk-to-gl, ping-pong, ring, fan-out,\nhost-in-the-middle, wait-before-signal,\n"
              "resize-storm, create-destroy-storm or all");
    addChoice(c, "--backend", o.backend, stress::kBackends, "NAME", "bridged, finish, native, binary or all");
    addChoice(c, "--resource", o.resource, stress::kResources, "NAME", "colour, D32F, R32F, buffer or all");
    addChoice(c, "--topology", o.topology, stress::kTopologies, "NAME",
              "one-thread, bridge-thread, two-processes or all");
    addChoice(c, "--fault", o.fault, stress::kFaults, "NAME",
              "none (if not given), drop, delay, duplicate,\nskip-wait, wrong-value, early-reuse, swap,\nwrong-layout "
              "or all");
    auto* preset = c.add_option_function<std::string>(
        "--preset",
        [&o](const std::string& text) {
            if (text != "piglit") {
                throw CLI::ValidationError(badValue("--preset", "piglit", text).message());
            }
            o.pattern = stress::Pattern::PingPong;
            o.backend = stress::Backend::Bridged;
            o.topology = stress::Topology::BridgeThread;
            o.alternations = true;
            o.handoffs = 3 * stress::kAlternations;
        },
        "piglit: 255 x 128 alternations each through a\ncolour image, a depth image and a buffer");
    preset->type_name("NAME");
    for (const char* other :
         {"--pattern", "--backend", "--resource", "--topology", "--fault", "--handoffs", "--seconds"}) {
        preset->excludes(c.get_option(other));
    }
    c.add_option("--log", o.log, "where to keep the ledger's log of the first failure;\nstress-SEED.sluicelog")
        ->type_name("FILE");
    c.add_flag("--json", o.json, "as JSON on stdout");
    c.footer(
        "What is not named is run through whole; native and binary only when named.\n"
        "Example:\n  sluice stress --pattern ring --fault skip-wait --handoffs 2000\n\n"
        "Exit codes of stress:\n"
        "  0    every texel right and nothing found; with --fault: each one was seen by\n"
        "       the pixels or the ledger, and a mere delay by neither\n"
        "  1    the command line is wrong\n"
        "  3    it failed (the command that repeats it is printed), or cannot run here\n"
        "  4    the file of --log cannot be written: nothing was run\n"
        "  130  interrupted\n");
    c.callback([&] { run = [&o] { return stress(o); }; });
}

}  // namespace sluice::cli
