// SPDX-License-Identifier: MIT
#include "app/ledger_commands.hpp"

#include <CLI/CLI.hpp>

#include "app/parse_values.hpp"

namespace sluice::cli {

void addLedgerCommands(CLI::App& app, LedgerCommands& commands, std::function<int()>& run) {
    DiagnoseOptions& o = commands.diagnose;
    CLI::App& c = *app.add_subcommand("diagnose", "Judge the order of events in a ledger log");
    c.add_option("LOG", o.log, "ledger log, as sluice_trace.h writes it")->required()->type_name("");
    c.add_option_function<std::string>(
         "--frame",
         [&o](const std::string& text) {
             const auto number = parseWhole("--frame", text);
             if (!number || number.value() > 0xFFFFFFFF) {
                 throw CLI::ValidationError(badValue("--frame", "the number of a frame", text).message());
             }
             o.frame = static_cast<std::uint32_t>(number.value());
         },
         "frame whose critical path is printed instead of\nthe longest")
        ->type_name("N");
    c.add_flag("--all", o.all, "every finding, not three of each kind");
    auto* json = c.add_flag("--json", o.json, "everything as JSON on stdout (docs/diagnose.md)");
    c.add_flag("-q,--quiet", o.quiet, "print nothing but errors; not with --json")->excludes(json);
    c.add_option("--trace", o.trace, "Chrome trace to write, for Perfetto: arrows from\nsignals to waits, findings")
        ->type_name("JSON");
    c.add_option("--html", o.html, "page to write: the frames drawn, readable without\na network")->type_name("HTML");
    c.add_option_function<std::string>(
         "--frames",
         [&o](const std::string& text) {
             const auto range = parseFrameRange(text);
             if (!range) {
                 throw CLI::ValidationError(range.error().message());
             }
             o.frames = range.value();
         },
         "frames of the page instead of all (or the 2,000\nfrom the first finding on)")
        ->type_name("A..B");
    c.footer(
        "Exit codes of diagnose:\n"
        "  0    clean, or remarks alone\n"
        "  1    findings (or the command line is wrong: then nothing is on stdout)\n"
        "  2    the log cannot be read, or holds no event\n"
        "  4    --trace or --html cannot be written\n");
    c.callback([&] { run = [&o] { return diagnose(o); }; });

    ExplainFindingOptions& e = commands.explain_finding;
    CLI::App& x = *app.add_subcommand("explain-finding", "Say what a kind of finding means and what to change");
    x.add_option("ID", e.id, "such as race-read-after-write; without it, the list")->type_name("");
    x.add_flag("--json", e.json, "as JSON on stdout");
    x.footer(
        "Examples:\n"
        "  sluice explain-finding\n"
        "  sluice explain-finding race-read-after-write\n\n"
        "Exit codes of explain-finding:\n"
        "  0    done\n"
        "  1    no kind of finding has that ID, or the command line is wrong\n");
    x.callback([&] { run = [&e] { return explainFinding(e); }; });
}

}  // namespace sluice::cli
