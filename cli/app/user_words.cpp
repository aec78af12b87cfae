// SPDX-License-Identifier: MIT
#include "app/user_words.hpp"

#include <array>
#include <utility>

namespace sluice::cli {
namespace {

/// What the program does by itself is no advice.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kWords{
    {{"raise wait_timeout_ns", "raise --deadline"},
     {" (destroy the renderer and create it again)", ""},
     {" (destroy the FluidHost and create it again)", ""},
     {"given up; destroy the FluidHost and create it again", "given up"},
     {"create another context, and a FluidHost in it", "the rest of this run has no fluid; run it again from here"},
     {" (isolate the renderer)", " (give --isolate)"},
     {" (give it to FluidHostConfig)", ""}}};

}  // namespace

std::string inUserWords(std::string_view message) {
    std::string text(message);
    for (const auto& [theirs, ours] : kWords) {
        for (std::size_t at = text.find(theirs); at != std::string::npos; at = text.find(theirs, at + ours.size())) {
            text.replace(at, theirs.size(), ours);
        }
    }
    return text;
}

}  // namespace sluice::cli
