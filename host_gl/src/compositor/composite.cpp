// SPDX-License-Identifier: MIT
#include "compositor/composite.hpp"

#include <epoxy/gl.h>

#include <utility>

#include "compositor/draw_guard.hpp"
#include "compositor/screen_binding.hpp"

namespace sluice::host {

namespace {

constexpr std::string_view kFragmentSource = R"(uniform sampler2D fluid_colour;
uniform sampler2D fluid_depth;
uniform vec2 texel;  // 1 / size
void main() {
    vec2 at = gl_FragCoord.xy * texel;
    vec4 colour = SAMPLE(fluid_colour, at);
    if (!(colour.a > 0.0)) {
        discard;
    }
    FRAGMENT = colour;
    gl_FragDepth = SAMPLE(fluid_depth, at).r;
}
)";

}  // namespace

Result<Compositor> Compositor::create() {
    Result<GlProgram> program = GlProgram::create("composite", kFragmentSource);
    if (!program) {
        return program.error();
    }
    Compositor compositor;
    compositor.program_ = std::move(program).value();
    compositor.texel_ = compositor.program_.uniform("texel");
    compositor.colour_ = compositor.program_.uniform("fluid_colour");
    compositor.depth_ = compositor.program_.uniform("fluid_depth");
    return compositor;
}

void Compositor::draw(std::uint32_t framebuffer, std::uint32_t width, std::uint32_t height, std::uint32_t colour,
                      std::uint32_t depth) const {
    const DrawBinding target(framebuffer);
    const DrawGuard state(static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    const UnitGuard units;
    glBindTexture(GL_TEXTURE_2D, colour);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, depth);
    glActiveTexture(GL_TEXTURE0);

    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    // Index 0 and no other where blending is indexed; DrawGuard has saved exactly that.
    if (epoxy_gl_version() >= 30) {
        glEnablei(GL_BLEND, 0);
    } else {
        glEnable(GL_BLEND);
    }
    if (epoxy_gl_version() >= 40 || epoxy_has_gl_extension("GL_ARB_draw_buffers_blend")) {
        glBlendFuncSeparatei(0, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glBlendEquationSeparatei(0, GL_FUNC_ADD, GL_FUNC_ADD);
    } else {
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glBlendEquationSeparate(GL_FUNC_ADD, GL_FUNC_ADD);
    }
    glUseProgram(program_.name());
    glUniform1i(colour_, 0);
    glUniform1i(depth_, 1);
    glUniform2f(texel_, 1.0F / static_cast<GLfloat>(width), 1.0F / static_cast<GLfloat>(height));
    drawScreenTriangle();
}

}  // namespace sluice::host
