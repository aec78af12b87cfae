// SPDX-License-Identifier: MIT
#include "compositor/gl_program.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <string>

#include "context/profile.hpp"

namespace sluice::host {

namespace {

constexpr std::string_view kVertexSource = R"(#version 120
void main() { gl_Position = vec4(gl_Vertex.xy, 0.0, 1.0); }
)";
constexpr std::string_view kFragmentHead = R"(#version 120
#define FRAGMENT gl_FragColor
#define SAMPLE texture2D
)";
// GLSL 1.40 is what OpenGL 3.1 has and what every later core profile still takes.
constexpr std::string_view kCoreVertexSource = R"(#version 140
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)";
constexpr std::string_view kCoreFragmentHead = R"(#version 140
out vec4 FRAGMENT;
#define SAMPLE texture
)";

class Shader {
  public:
    Shader(GLenum stage, std::string_view source) : shader_(glCreateShader(stage)) {
        const char* text = source.data();
        const auto length = static_cast<GLint>(source.size());
        glShaderSource(shader_, 1, &text, &length);
        glCompileShader(shader_);
    }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    ~Shader() { glDeleteShader(shader_); }

    [[nodiscard]] GLuint name() const { return shader_; }
    [[nodiscard]] bool compiled() const {
        GLint status = GL_FALSE;
        glGetShaderiv(shader_, GL_COMPILE_STATUS, &status);
        return status == GL_TRUE;
    }
    [[nodiscard]] std::string log() const {
        GLint length = 0;
        glGetShaderiv(shader_, GL_INFO_LOG_LENGTH, &length);
        std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetShaderInfoLog(shader_, length, &length, text.data());
        text.resize(static_cast<std::size_t>(std::max(length, 0)));
        return text;
    }

  private:
    GLuint shader_;
};

std::string linkLog(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program, length, &length, text.data());
    text.resize(static_cast<std::size_t>(std::max(length, 0)));
    return text;
}

Error broken(std::string_view name, std::string detail) {
    return {SLUICE_ERROR_UNSUPPORTED, "GLSL program '" + std::string(name) + "'", std::move(detail),
            "the GL driver must compile GLSL 1.20, or 1.40 in a core profile"};
}

}  // namespace

Result<GlProgram> GlProgram::create(std::string_view name, std::string_view fragment_source) {
    const bool fixed_function = hasFixedFunction();
    const Shader vertex(GL_VERTEX_SHADER, fixed_function ? kVertexSource : kCoreVertexSource);
    const Shader fragment(GL_FRAGMENT_SHADER,
                          std::string(fixed_function ? kFragmentHead : kCoreFragmentHead).append(fragment_source));
    for (const Shader* shader : {&vertex, &fragment}) {
        if (!shader->compiled()) {
            return broken(name, "does not compile: " + shader->log());
        }
    }
    GlProgram program;
    program.program_ = glCreateProgram();
    glAttachShader(program.program_, vertex.name());
    glAttachShader(program.program_, fragment.name());
    glLinkProgram(program.program_);
    GLint linked = GL_FALSE;
    glGetProgramiv(program.program_, GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        return broken(name, "does not link: " + linkLog(program.program_));
    }
    glDetachShader(program.program_, vertex.name());
    glDetachShader(program.program_, fragment.name());
    return program;
}

GlProgram::~GlProgram() {
    if (program_ != 0 && !glGone()) {
        glDeleteProgram(program_);
    }
}

std::int32_t GlProgram::uniform(const char* name) const {
    return glGetUniformLocation(program_, name);
}

void drawScreenTriangle() {
    if (!hasFixedFunction()) {
        GLint bound = 0;
        glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &bound);
        // Vertex arrays belong to one context, programs to a share group: it is made where it is used.
        GLuint empty = 0;
        glGenVertexArrays(1, &empty);
        glBindVertexArray(empty);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindVertexArray(static_cast<GLuint>(bound));
        glDeleteVertexArrays(1, &empty);
        return;
    }
    glBegin(GL_TRIANGLES);
    glVertex2f(-1.0F, -1.0F);
    glVertex2f(3.0F, -1.0F);
    glVertex2f(-1.0F, 3.0F);
    glEnd();
}

}  // namespace sluice::host
