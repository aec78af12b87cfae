// SPDX-License-Identifier: MIT
// State that newer versions keep per viewport or per draw buffer. The commands of 2.1 set all of them at once, so equal
// values are written once: a single change is then a single line.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "state/writer.hpp"

namespace sluice::host::state {
namespace {

std::string collapse(const std::vector<std::string>& values) {
    if (std::all_of(values.begin(), values.end(), [&](const std::string& v) { return v == values.front(); })) {
        return values.front();
    }
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
        text += fmt::format("{}[{}] {}", i == 0 ? "" : " ", i, values[i]);
    }
    return text;
}

template <typename Query>
void writeIndexed(Writer& writer, const char* name, int count, const Query& query) {
    std::vector<std::string> values;
    values.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        values.push_back(query(static_cast<GLuint>(i)));
    }
    writer.put(name, collapse(values));
}

std::string indexedIntegers(GLenum pname, GLuint index, int count, Kind kind) {
    std::array<GLint, 4> values{};
    glGetIntegeri_v(pname, index, values.data());
    return integersText(values.data(), count, kind);
}

void writeViewports(Writer& writer) {
    const int viewports = available({41, "GL_ARB_viewport_array"}) ? queryInteger(GL_MAX_VIEWPORTS) : 1;
    if (viewports <= 1) {
        writer.query("GL_VIEWPORT", GL_VIEWPORT, Kind::Float, 4);
        writer.query("GL_DEPTH_RANGE", GL_DEPTH_RANGE, Kind::Float, 2);
        writer.query("GL_SCISSOR_BOX", GL_SCISSOR_BOX, Kind::Integer, 4);
        writer.query("GL_SCISSOR_TEST", GL_SCISSOR_TEST, Kind::Flag);
        return;
    }
    writeIndexed(writer, "GL_VIEWPORT", viewports, [](GLuint i) {
        std::array<GLfloat, 4> box{};
        glGetFloati_v(GL_VIEWPORT, i, box.data());
        return floatsText(box.data(), 4);
    });
    writeIndexed(writer, "GL_DEPTH_RANGE", viewports, [](GLuint i) {
        std::array<GLdouble, 2> range{};
        glGetDoublei_v(GL_DEPTH_RANGE, i, range.data());
        return fmt::format("{} {}", range[0], range[1]);
    });
    writeIndexed(writer, "GL_SCISSOR_BOX", viewports,
                 [](GLuint i) { return indexedIntegers(GL_SCISSOR_BOX, i, 4, Kind::Integer); });
    writeIndexed(writer, "GL_SCISSOR_TEST", viewports,
                 [](GLuint i) { return std::string(glIsEnabledi(GL_SCISSOR_TEST, i) == GL_TRUE ? "1" : "0"); });
}

void writeBlend(Writer& writer, int buffers) {
    struct Row {
        const char* name;
        GLenum pname;
    };
    static constexpr std::array kRows{
        Row{"GL_BLEND_SRC_RGB", GL_BLEND_SRC_RGB},           Row{"GL_BLEND_DST_RGB", GL_BLEND_DST_RGB},
        Row{"GL_BLEND_SRC_ALPHA", GL_BLEND_SRC_ALPHA},       Row{"GL_BLEND_DST_ALPHA", GL_BLEND_DST_ALPHA},
        Row{"GL_BLEND_EQUATION_RGB", GL_BLEND_EQUATION_RGB}, Row{"GL_BLEND_EQUATION_ALPHA", GL_BLEND_EQUATION_ALPHA}};
    const bool separate = available({40, "GL_ARB_draw_buffers_blend"});
    for (const Row& row : kRows) {
        if (separate) {
            writeIndexed(writer, row.name, buffers,
                         [&row](GLuint i) { return indexedIntegers(row.pname, i, 1, Kind::Enumerant); });
        } else {
            writer.query(row.name, row.pname, Kind::Enumerant);
        }
    }
}

void writeDrawBuffers(Writer& writer) {
    const int buffers = std::max(1, queryInteger(GL_MAX_DRAW_BUFFERS));
    for (int i = 0; i < buffers; ++i) {
        writer.query(numbered("GL_DRAW_BUFFER", i), GL_DRAW_BUFFER0 + static_cast<GLenum>(i), Kind::Enumerant);
    }
    if (available({30, nullptr})) {
        writeIndexed(writer, "GL_BLEND", buffers,
                     [](GLuint i) { return std::string(glIsEnabledi(GL_BLEND, i) == GL_TRUE ? "1" : "0"); });
        writeIndexed(writer, "GL_COLOR_WRITEMASK", buffers, [](GLuint i) {
            std::array<GLboolean, 4> mask{};
            glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask.data());
            return fmt::format("{} {} {} {}", mask[0], mask[1], mask[2], mask[3]);
        });
    } else {
        writer.query("GL_BLEND", GL_BLEND, Kind::Flag);
        writer.query("GL_COLOR_WRITEMASK", GL_COLOR_WRITEMASK, Kind::Integer, 4);
    }
    writeBlend(writer, buffers);
}

void writeSampleMask(Writer& writer) {
    if (!available({32, "GL_ARB_texture_multisample"})) {
        return;
    }
    const int words = std::max(1, queryInteger(GL_MAX_SAMPLE_MASK_WORDS));
    writeIndexed(writer, "GL_SAMPLE_MASK_VALUE", words,
                 [](GLuint i) { return indexedIntegers(GL_SAMPLE_MASK_VALUE, i, 1, Kind::Enumerant); });
}

void writeQueries(Writer& writer) {
    struct Row {
        const char* name;
        GLenum target;
        Since since{};
    };
    static constexpr std::array kRows{
        Row{"GL_SAMPLES_PASSED", GL_SAMPLES_PASSED},
        Row{"GL_PRIMITIVES_GENERATED", GL_PRIMITIVES_GENERATED, {30, nullptr}},
        Row{"GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN", GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, {30, nullptr}},
        Row{"GL_TIME_ELAPSED", GL_TIME_ELAPSED, {33, "GL_ARB_timer_query"}},
        Row{"GL_ANY_SAMPLES_PASSED", GL_ANY_SAMPLES_PASSED, {33, "GL_ARB_occlusion_query2"}},
        Row{"GL_ANY_SAMPLES_PASSED_CONSERVATIVE", GL_ANY_SAMPLES_PASSED_CONSERVATIVE, {43, "GL_ARB_ES3_compatibility"}},
    };
    for (const Row& row : kRows) {
        if (available(row.since)) {
            GLint query = 0;
            glGetQueryiv(row.target, GL_CURRENT_QUERY, &query);
            writer.put(member("query", row.name), integersText(&query, 1, Kind::Integer));
        }
    }
}

}  // namespace

void writeOutputs(Writer& writer) {
    writeViewports(writer);
    writeDrawBuffers(writer);
    writeSampleMask(writer);
    writeQueries(writer);
}

}  // namespace sluice::host::state
