// SPDX-License-Identifier: MIT
// What the libraries advise the program that calls them, as advice for whoever has typed a command.
#pragma once

#include <string>
#include <string_view>

namespace sluice::cli {

[[nodiscard]] std::string inUserWords(std::string_view message);

}  // namespace sluice::cli
