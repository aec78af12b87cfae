// SPDX-License-Identifier: MIT
// What --help prints.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace sluice::cli {

/// A page of 80 columns: what must be given stands in the usage line, values have names instead of C++ types.
[[nodiscard]] std::shared_ptr<CLI::Formatter> helpFormatter();

/// The last part of every page.
[[nodiscard]] const char* exitCodesHelp();

/// One line about a word that is no command, with the nearest of `app`'s commands.
[[nodiscard]] std::string unknownCommand(const CLI::App& app, const std::string& word);

/// One line about a command line that CLI11 does not take, with the nearest option where one was misspelt.
[[nodiscard]] std::string usageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace sluice::cli
