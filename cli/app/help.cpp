// SPDX-License-Identifier: MIT
#include "app/help.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "scene/nearest.hpp"

namespace sluice::cli {
namespace {

bool named(const CLI::App* command) {
    return !command->get_name().empty();
}

class HelpFormatter : public CLI::Formatter {
  public:
    HelpFormatter() {
        column_width(28);
        label("Positionals", "Arguments");
    }

    /// CLI11 would add defaults, REQUIRED and the descriptions of validators here.
    std::string make_option_opts(const CLI::Option* option) const override {
        return option->get_type_size() == 0 || option->get_type_name().empty() ? "" : " " + option->get_type_name();
    }

    std::string make_usage(const CLI::App* app, std::string name) const override {
        std::string text = "Usage: " + name;
        for (const CLI::Option* option : app->get_options()) {
            if (option->get_positional()) {
                const std::string word = option->get_name(true);
                text += option->get_required() ? " " + word : " [" + word + "]";
            }
        }
        for (const CLI::Option* option : app->get_options()) {
            if (option->nonpositional() && option->get_required()) {
                text += fmt::format(" -{}{}", option->get_snames().front(), make_option_opts(option));
            }
        }
        text += app->get_subcommands(named).empty() ? " [OPTIONS]\n" : " COMMAND\n";
        return text;
    }
};

/// "sluice generate pool"
std::string nameOf(const CLI::App& app) {
    return app.get_parent() == nullptr ? "sluice" : nameOf(*app.get_parent()) + " " + app.get_name();
}

std::string unknownWord(const CLI::App& app, const std::string& word, const char* what,
                        const std::vector<std::string>& names) {
    const std::vector<std::string_view> views(names.begin(), names.end());
    const std::string_view guess = scene::nearest(word, views);
    return fmt::format("sluice: error: \"{}\" is no {}{} ({} --help lists them)\n", word, what,
                       guess.empty() ? "" : fmt::format("; the nearest is \"{}\"", guess), nameOf(app));
}

}  // namespace

std::shared_ptr<CLI::Formatter> helpFormatter() {
    return std::make_shared<HelpFormatter>();
}

const char* exitCodesHelp() {
    return "Exit codes:\n"
           "  0    done\n"
           "  1    the command line is wrong\n"
           "  2    an input file is missing or wrong: no output was written for it\n"
           "  3    the renderer is missing or failed, or nothing can be shared here: the\n"
           "       host's own frames were still written, without fluid; or --validation\n"
           "       had something to say\n"
           "  4    no OpenGL, not enough memory, an output that cannot be written, or an\n"
           "       internal fault\n"
           "  130  interrupted; the file in hand was finished\n";
}

std::string unknownCommand(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands(named)) {
        names.push_back(command->get_name());
    }
    return unknownWord(app, word, "command", names);
}

std::string usageError(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) {
        command = command->get_subcommands().front();
    }
    // Before all else: an option that was misspelt is often one that is now missing.
    for (const std::string& word : app.remaining(true)) {
        if (word.size() > 1 && word.front() == '-') {
            std::vector<std::string> names;
            for (const CLI::Option* option : command->get_options()) {
                for (const std::string& name : option->get_lnames()) {
                    names.push_back("--" + name);
                }
            }
            return unknownWord(*command, word.substr(0, word.find('=')), "option", names);
        }
    }
    if (const std::vector<std::string> words = app.remaining(true); !words.empty()) {
        return fmt::format("sluice: error: \"{}\" is one argument too many ({} --help lists them)\n", words.front(),
                           nameOf(*command));
    }
    const std::string_view what = error.what();
    // CLI11 words it as a count of arguments: "--size: At Most 1 required but received 2".
    if (const std::size_t once = what.find(": At Most 1 required but received "); once != std::string_view::npos) {
        return fmt::format("sluice: error: {} may be given once, found it {} times\n", what.substr(0, once),
                           what.substr(what.rfind(' ') + 1));
    }
    // A value that is wrong has its remedy with it; what is missing has not.
    const bool told = what.find("found") != std::string_view::npos;
    return told ? fmt::format("sluice: error: {}\n", what)
                : fmt::format("sluice: error: {} ({} --help)\n", what, nameOf(*command));
}

}  // namespace sluice::cli
