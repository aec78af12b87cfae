// SPDX-License-Identifier: MIT
#include "api/told.hpp"

#include <cctype>

namespace sluice::host {

namespace {

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool isWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Past the number or the word at the beginning of `text`.
std::size_t endOfToken(std::string_view text) {
    std::size_t end = 1;
    while (end < text.size()) {
        const char before = text[end - 1];
        const bool exponent = (text[end] == '-' || text[end] == '+') && (before == 'e' || before == 'E');
        const bool point = text[end] == '.' && end + 1 < text.size() && isDigit(text[end + 1]);
        if (!isWord(text[end]) && !(isDigit(text[0]) && (point || exponent))) {
            break;
        }
        ++end;
    }
    return end;
}

}  // namespace

std::string withoutNumbers(std::string_view text) {
    std::string kept;
    for (std::size_t at = 0; at < text.size();) {
        if (!isWord(text[at])) {
            kept += text[at++];
            continue;
        }
        const std::string_view token = text.substr(at, endOfToken(text.substr(at)));
        at += token.size();
        if (!isDigit(token[0]) && token != "nan" && token != "inf") {
            kept += token;
            continue;
        }
        if (!kept.empty() && kept.back() == '-') {
            kept.pop_back();
        }
        kept += '#';
    }
    return kept;
}

bool Told::isNews(const std::string& text, Once once) {
    if (once == Once::Kind) {
        return kinds_.insert(withoutNumbers(text)).second;
    }
    return texts_.size() < kMostTexts && texts_.insert(text).second;
}

}  // namespace sluice::host
