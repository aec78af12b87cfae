// SPDX-License-Identifier: MIT
#include "compositor/linear_depth.hpp"

#include <epoxy/gl.h>

#include <limits>
#include <utility>

#include "compositor/draw_guard.hpp"
#include "compositor/screen_binding.hpp"
#include "context/profile.hpp"
#include "screen/gl_guards.hpp"

namespace sluice::host {

namespace {

// Infinity comes as a uniform: GLSL 1.20 can neither write the literal nor rely on a division by zero.
constexpr std::string_view kFragmentSource = R"(uniform sampler2D window_depth;
uniform vec2 texel;         // 1 / size
uniform vec4 coefficients;  // n0, n1, d0, d1
uniform float infinity;
void main() {
    float depth = SAMPLE(window_depth, gl_FragCoord.xy * texel).r;
    float e = 1.0 - depth;
    float metres = (coefficients.x + coefficients.y * e) / (coefficients.z + coefficients.w * e);
    FRAGMENT = vec4(depth < 1.0 ? metres : infinity, 0.0, 0.0, 1.0);
}
)";

}  // namespace

LinearDepthMap linearDepthMap(const std::array<float, 16>& projection) {
    const double p10{projection[10]};
    const double p11{projection[11]};
    const double p14{projection[14]};
    const double p15{projection[15]};
    return {.n0 = p15 - p14, .n1 = -2.0 * p15, .d0 = p11 - p10, .d1 = -2.0 * p11};
}

Result<LinearDepthPass> LinearDepthPass::create(std::uint32_t width, std::uint32_t height) {
    Result<GlProgram> program = GlProgram::create("linear depth", kFragmentSource);
    if (!program) {
        return program.error();
    }
    LinearDepthPass pass;
    pass.program_ = std::move(program).value();
    pass.coefficients_ = pass.program_.uniform("coefficients");
    pass.infinity_ = pass.program_.uniform("infinity");
    pass.texel_ = pass.program_.uniform("texel");
    pass.width_ = width;
    pass.height_ = height;
    // Of the screen's own precision at least: the copy then loses nothing.
    const bool has_float = epoxy_gl_version() >= 30 || epoxy_has_gl_extension("GL_ARB_depth_buffer_float");
    const PixelGuard pixels;
    const TextureGuard texture;
    glGenTextures(1, &pass.depth_);
    glBindTexture(GL_TEXTURE_2D, pass.depth_);
    glTexImage2D(GL_TEXTURE_2D, 0, has_float ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24,
                 static_cast<GLsizei>(width), static_cast<GLsizei>(height), 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glGenFramebuffers(1, &pass.framebuffer_);
    return pass;
}

void LinearDepthPass::run(std::uint32_t screen_framebuffer, std::uint32_t target,
                          const std::array<float, 16>& projection) const {
    const auto width = static_cast<GLsizei>(width_);
    const auto height = static_cast<GLsizei>(height_);
    const DrawGuard state(width, height);
    const UnitGuard units;
    glBindTexture(GL_TEXTURE_2D, depth_);
    {
        const PixelGuard pixels;
        const ReadBinding source(screen_framebuffer);
        glCopyTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 0, 0, width, height);
    }
    const FramebufferGuard bindings;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    const LinearDepthMap map = linearDepthMap(projection);
    glUseProgram(program_.name());
    glUniform4f(coefficients_, static_cast<GLfloat>(map.n0), static_cast<GLfloat>(map.n1), static_cast<GLfloat>(map.d0),
                static_cast<GLfloat>(map.d1));
    glUniform1f(infinity_, std::numeric_limits<GLfloat>::infinity());
    glUniform2f(texel_, 1.0F / static_cast<GLfloat>(width), 1.0F / static_cast<GLfloat>(height));
    drawScreenTriangle();
    // Our framebuffer must not keep a retired image alive.
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
}

void LinearDepthPass::swap(LinearDepthPass& other) noexcept {
    std::swap(program_, other.program_);
    std::swap(coefficients_, other.coefficients_);
    std::swap(infinity_, other.infinity_);
    std::swap(texel_, other.texel_);
    std::swap(depth_, other.depth_);
    std::swap(framebuffer_, other.framebuffer_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
}

LinearDepthPass::LinearDepthPass(LinearDepthPass&& other) noexcept {
    swap(other);
}

LinearDepthPass& LinearDepthPass::operator=(LinearDepthPass&& other) noexcept {
    swap(other);
    return *this;
}

LinearDepthPass::~LinearDepthPass() {
    if (glGone()) {
        return;
    }
    if (framebuffer_ != 0) {
        glDeleteFramebuffers(1, &framebuffer_);
    }
    if (depth_ != 0) {
        glDeleteTextures(1, &depth_);
    }
}

}  // namespace sluice::host
