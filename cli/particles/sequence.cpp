// SPDX-License-Identifier: MIT
// Names of numbered files. The pattern comes from a user, so it is taken apart here and never given to printf.
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "failure.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::particles {

namespace {

constexpr int kMaxWidth = 20;

struct Number {
    std::size_t at = 0;      ///< where it begins
    std::size_t length = 0;  ///< how many characters of the pattern it takes
    int width = 0;
    bool zeros = false;
};

struct Parsed {
    std::string before;
    std::string after;
    std::optional<Number> number;
};

Error badPattern(const std::string& pattern, const std::string& detail, const std::string& remedy) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, pattern, detail, remedy};
}

/// The conversion that starts with the '%' at `at`: %d, %i, %u with an optional zero flag and width.
std::optional<Number> parseConversion(std::string_view pattern, std::size_t at) {
    Number number{at, 0, 0, false};
    std::size_t i = at + 1;
    if (i < pattern.size() && pattern[i] == '0') {
        number.zeros = true;
        ++i;
    }
    for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9'; ++i) {
        number.width = number.width * 10 + (pattern[i] - '0');
        if (number.width > kMaxWidth) {
            return std::nullopt;
        }
    }
    if (i >= pattern.size() || (pattern[i] != 'd' && pattern[i] != 'i' && pattern[i] != 'u')) {
        return std::nullopt;
    }
    number.length = i + 1 - at;
    return number;
}

Result<Parsed> parsePattern(const std::string& pattern) {
    Parsed parsed;
    for (std::size_t i = 0; i < pattern.size();) {
        std::string& text = parsed.number ? parsed.after : parsed.before;
        if (pattern[i] == '%' && i + 1 < pattern.size() && pattern[i + 1] == '%') {
            text += '%';
            i += 2;
            continue;
        }
        if (pattern[i] != '%' && pattern[i] != '#') {
            text += pattern[i++];
            continue;
        }
        if (parsed.number) {
            return badPattern(pattern, fmt::format("expected one frame number, found a second at character {}", i + 1),
                              "keep one of them; write %% for a percent sign");
        }
        if (pattern[i] == '#') {
            const std::size_t end = std::min(pattern.find_first_not_of('#', i), pattern.size());
            if (end - i > static_cast<std::size_t>(kMaxWidth)) {
                return badPattern(pattern, fmt::format("expected at most {} '#' at character {}", kMaxWidth, i + 1),
                                  "");
            }
            parsed.number = Number{i, end - i, static_cast<int>(end - i), true};
        } else {
            parsed.number = parseConversion(pattern, i);
            if (!parsed.number) {
                return badPattern(pattern,
                                  fmt::format("expected an integer conversion such as %04d at character {}, found {}",
                                              i + 1, printable(std::string_view(pattern).substr(i, 4))),
                                  "write %d, %i or %u with a width of at most 20, or %% for a percent sign");
            }
        }
        i += parsed.number->length;
    }
    return parsed;
}

}  // namespace

bool Sequence::numbered() const {
    const Result<Parsed> parsed = parsePattern(pattern);
    // A broken pattern counts as numbered, so that path() gets to tell what is wrong with it.
    return !parsed || parsed.value().number.has_value();
}

Result<std::filesystem::path> Sequence::path(std::int64_t frame) const {
    if (pattern.empty()) {
        return badPattern("particle files", "the pattern is empty", "give a file name such as frame_%04d.pos");
    }
    const Result<Parsed> parsed = parsePattern(pattern);
    if (!parsed) {
        return parsed.error();
    }
    const Parsed& parts = parsed.value();
    if (!parts.number) {
        return std::filesystem::path(parts.before);
    }
    const std::string number = parts.number->zeros ? fmt::format("{:0{}d}", frame, parts.number->width)
                                                   : fmt::format("{:{}d}", frame, parts.number->width);
    return std::filesystem::path(parts.before + number + parts.after);
}

}  // namespace sluice::particles
