// SPDX-License-Identifier: MIT
#include <CLI/CLI.hpp>
#include <charconv>

#include "app/inject.hpp"
#include "app/parse_values.hpp"

namespace sluice::cli {

void addInjectCommand(CLI::App& app, InjectOptions& options, std::function<int()>& run) {
    InjectOptions& o = options;
    CLI::App& c = *app.add_subcommand("inject", "Run an unmodified OpenGL program with fluid in it");
    c.add_option("--scene", o.scene, "scene whose water, look and sky are taken")->type_name("FILE");
    c.add_option("--profile", o.profile, "what is known of the program (docs/inject.md)")->type_name("FILE");
    auto* report = c.add_flag("--report", o.report, "print at the end what was seen in the program");
    c.add_option("--report-to", o.report_to, "the report into this file, apart from what the\nprogram prints")
        ->type_name("FILE")
        ->needs(report);
    c.add_flag("--json", o.json, "the report as JSON")->needs(report);
    c.add_flag("--off", o.off, "no fluid: watch only");
    c.add_flag("--children", o.children, "processes that the program starts get it, too");
    c.add_flag("--same-process", o.same_process, "no process of its own for the renderer");
    c.add_option("--plugin", o.plugin, "renderer plugin instead of the one found")->type_name("PATH");
    c.add_option_function<std::string>(
         "--step",
         [&o](const std::string& text) {
             const char* const end = text.data() + text.size();
             const auto [stop, code] = std::from_chars(text.data(), end, o.step_s);
             if (code != std::errc() || stop != end || !(o.step_s > 0.0 && o.step_s <= 1.0)) {
                 throw CLI::ValidationError(badValue("--step", "seconds above 0, at most 1", text).message());
             }
         },
         "seconds that the fluid flows per frame instead of\nthe clock's")
        ->type_name("SECONDS");
    c.add_option("PROGRAM", o.command, "and its arguments, behind --")->required()->type_name("ARGS");
    c.footer(
        "Examples:\n"
        "  sluice inject -- glxgears\n"
        "  sluice inject --off --report -- glxgears -info\n\n"
        "Exit code: the program's own; 1, 2 or 4 as below if it was not started, 126\n"
        "or 127 if it cannot be, 128 + N if signal N ended it.\n");
    c.callback([&o, &run] { run = [&o] { return inject(o); }; });
}

}  // namespace sluice::cli
