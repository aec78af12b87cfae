// SPDX-License-Identifier: MIT
#include "state/writer.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "screen/gl_guards.hpp"

namespace sluice::host::state {
namespace {

constexpr int kMostValues = 16;

}  // namespace

bool available(const Since& since) {
    if (epoxy_gl_version() >= since.version) {
        return true;
    }
    return since.extension != nullptr && epoxy_has_gl_extension(since.extension);
}

std::string integersText(const GLint* values, int count, Kind kind) {
    std::string text;
    for (int i = 0; i < count; ++i) {
        text += i == 0 ? "" : " ";
        text += kind == Kind::Enumerant ? fmt::format("0x{:04x}", static_cast<unsigned>(values[i]))
                                        : fmt::format("{}", values[i]);
    }
    return text;
}

std::string floatsText(const GLfloat* values, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
        text += fmt::format("{}{}", i == 0 ? "" : " ", values[i]);
    }
    return text;
}

GLint queryInteger(GLenum pname) {
    GLint value = 0;
    glGetIntegerv(pname, &value);
    return value;
}

std::string queryText(GLenum pname, Kind kind, int count) {
    if (kind == Kind::Flag) {
        return glIsEnabled(pname) == GL_TRUE ? "1" : "0";
    }
    if (kind == Kind::Float) {
        std::array<GLfloat, kMostValues> values{};
        glGetFloatv(pname, values.data());
        return floatsText(values.data(), count);
    }
    std::array<GLint, kMostValues> values{};
    glGetIntegerv(pname, values.data());
    return integersText(values.data(), count, kind);
}

void Writer::put(std::string name, std::string value) {
    if (glGetError() != GL_NO_ERROR) {
        clearGlErrors();
        value = "unavailable";
    }
    snapshot_.emplace_back(std::move(name), std::move(value));
}

void Writer::query(std::string name, GLenum pname, Kind kind, int count) {
    put(std::move(name), queryText(pname, kind, count));
}

std::string member(std::string_view object, std::string_view name) {
    return fmt::format("{}.{}", object, name);
}

std::string numbered(std::string_view stem, int index) {
    return fmt::format("{}{}", stem, index);
}

}  // namespace sluice::host::state
