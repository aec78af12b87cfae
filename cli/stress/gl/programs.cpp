// SPDX-License-Identifier: MIT
#include "stress/gl/programs.hpp"

#include <epoxy/gl.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stress/slots.hpp"

namespace sluice::stress {
namespace {

constexpr std::string_view kMix = R"(
uniform uint salt;
uniform uint inputs;
uniform uint width;
uniform uint texels;
uint mixWord(uint x, uint word, uint turn_salt, uint index) {
    x = (x * 0x9E3779B1u + word) & MASK;
    x = (x ^ (turn_salt + index * 0x85EBCA6Bu)) & MASK;
    x = (x * 0xC2B2AE35u) & MASK;
    x ^= x >> 11;
    x = (x * 0x27D4EB2Fu) & MASK;
    x ^= x >> 13;
    return x;
}
)";

constexpr std::string_view kVertex = R"(#version 130
void main() { gl_Position = vec4(gl_Vertex.xy, 0.0, 1.0); }
)";

constexpr std::string_view kOverImages = R"(
uniform sampler2D in0;
uniform sampler2D in1;
uniform sampler2D in2;
uniform sampler2D in3;
out vec4 result;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint index = uint(at.y) * width + uint(at.x);
    uint x = mixWord(0u, inputs == 0u ? 0u : WORD(texelFetch(in0, at, 0)), salt, index);
    if (inputs > 1u) { x = mixWord(x, WORD(texelFetch(in1, at, 0)), salt + 1u, index); }
    if (inputs > 2u) { x = mixWord(x, WORD(texelFetch(in2, at, 0)), salt + 2u, index); }
    if (inputs > 3u) { x = mixWord(x, WORD(texelFetch(in3, at, 0)), salt + 3u, index); }
    STORE(x);
}
)";

constexpr std::string_view kColourCodec = R"(#version 130
#define MASK 0xFFFFFFFFu
uint wordOf(vec4 texel) {
    uvec4 bytes = uvec4(texel * 255.0 + 0.5);
    return bytes.r | bytes.g << 8 | bytes.b << 16 | bytes.a << 24;
}
#define WORD(texel) wordOf(texel)
#define STORE(x) result = vec4(uvec4(x, x >> 8, x >> 16, x >> 24) & 255u) / 255.0
)";
constexpr std::string_view kFloatCodec = R"(#version 130
#define MASK 0xFFFFFFu
#define WORD(texel) uint((texel).r)
#define STORE(x) result = vec4(float(x), 0.0, 0.0, 1.0)
)";
constexpr std::string_view kDepthCodec = R"(#version 130
#define MASK 0xFFFFFFu
#define WORD(texel) uint((texel).r * 16777216.0)
#define STORE(x) result = vec4(0.0); gl_FragDepth = float(x) / 16777216.0
)";

constexpr std::string_view kBufferCodec = R"(#version 430
#define MASK 0xFFFFFFFFu
)";
constexpr std::string_view kOverBuffers = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer In0 { uint in0[]; };
layout(std430, binding = 1) readonly buffer In1 { uint in1[]; };
layout(std430, binding = 2) readonly buffer In2 { uint in2[]; };
layout(std430, binding = 3) readonly buffer In3 { uint in3[]; };
layout(std430, binding = 4) writeonly buffer Result { uint result[]; };
void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texels) { return; }
    uint x = mixWord(0u, inputs == 0u ? 0u : in0[index], salt, index);
    if (inputs > 1u) { x = mixWord(x, in1[index], salt + 1u, index); }
    if (inputs > 2u) { x = mixWord(x, in2[index], salt + 2u, index); }
    if (inputs > 3u) { x = mixWord(x, in3[index], salt + 3u, index); }
    result[index] = x;
}
)";

std::string_view codecOf(Resource resource) {
    switch (resource) {
        case Resource::Colour:
            return kColourCodec;
        case Resource::R32F:
            return kFloatCodec;
        case Resource::D32F:
            return kDepthCodec;
        case Resource::Buffer:
            break;
    }
    return kBufferCodec;
}

struct Stage {
    GLenum kind;
    std::string source;
};

std::string logOf(GLuint object, bool program) {
    std::array<GLchar, 1024> text{};
    GLsizei length = 0;
    if (program) {
        glGetProgramInfoLog(object, text.size(), &length, text.data());
    } else {
        glGetShaderInfoLog(object, text.size(), &length, text.data());
    }
    return {text.data(), static_cast<std::size_t>(length)};
}

Error broken(std::string detail) {
    return {SLUICE_ERROR_UNSUPPORTED, "GLSL of the stress test", std::move(detail),
            "it needs GLSL 1.30, and 4.30 for buffers"};
}

Status build(GLuint program, const std::vector<Stage>& stages) {
    for (const Stage& stage : stages) {
        const GLuint shader = glCreateShader(stage.kind);
        const GLchar* text = stage.source.c_str();
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        std::string log = compiled == GL_TRUE ? std::string() : logOf(shader, false);
        glAttachShader(program, shader);
        glDeleteShader(shader);  // kept by the program
        if (compiled != GL_TRUE) {
            return broken("does not compile: " + log);
        }
    }
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    return linked == GL_TRUE ? Status{} : Status{broken("does not link: " + logOf(program, true))};
}

}  // namespace

Result<TurnProgram> TurnProgram::create(Resource resource) {
    const std::string head = std::string(codecOf(resource)) + std::string(kMix);
    const std::vector<Stage> stages = resource == Resource::Buffer
                                          ? std::vector<Stage>{{GL_COMPUTE_SHADER, head + std::string(kOverBuffers)}}
                                          : std::vector<Stage>{{GL_VERTEX_SHADER, std::string(kVertex)},
                                                               {GL_FRAGMENT_SHADER, head + std::string(kOverImages)}};
    TurnProgram made;
    made.program_ = glCreateProgram();
    if (Status status = build(made.program_, stages); !status) {
        return status.error();
    }
    made.salt_ = glGetUniformLocation(made.program_, "salt");
    made.inputs_ = glGetUniformLocation(made.program_, "inputs");
    made.width_ = glGetUniformLocation(made.program_, "width");
    made.texels_ = glGetUniformLocation(made.program_, "texels");
    glUseProgram(made.program_);
    for (GLint unit = 0; unit < static_cast<GLint>(kMaxInputs) && resource != Resource::Buffer; ++unit) {
        const std::string name = "in" + std::to_string(unit);
        glUniform1i(glGetUniformLocation(made.program_, name.c_str()), unit);
    }
    return made;
}

void TurnProgram::use(std::uint32_t salt, std::uint32_t inputs, std::uint32_t width, std::uint32_t texels) const {
    glUseProgram(program_);
    glUniform1ui(salt_, salt);
    glUniform1ui(inputs_, inputs);
    glUniform1ui(width_, width);  // -1 where the program has no such uniform: ignored
    glUniform1ui(texels_, texels);
}

TurnProgram::TurnProgram(TurnProgram&& other) noexcept {
    *this = std::move(other);
}

TurnProgram& TurnProgram::operator=(TurnProgram&& other) noexcept {
    std::swap(program_, other.program_);
    salt_ = other.salt_;
    inputs_ = other.inputs_;
    width_ = other.width_;
    texels_ = other.texels_;
    return *this;
}

TurnProgram::~TurnProgram() {
    if (program_ != 0) {
        glDeleteProgram(program_);
    }
}

}  // namespace sluice::stress
