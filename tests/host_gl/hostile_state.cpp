// SPDX-License-Identifier: MIT
#include "hostile_state.hpp"

namespace sluice::host::test {

HostileState::HostileState(std::uint32_t screen) {
    setMatricesAndStacks();
    bindObjects();
    setRasterState();
    setPixelState();
    glBindFramebuffer(GL_FRAMEBUFFER, screen);
    glReadBuffer(GL_NONE);
    glDrawBuffer(GL_NONE);
}

void HostileState::bindObjects() {
    const GLuint shader = glCreateShader(GL_VERTEX_SHADER);
    const char* source = "#version 120\nvoid main() { gl_Position = vec4(2.0); }\n";
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    program_ = glCreateProgram();
    glAttachShader(program_, shader);
    glLinkProgram(program_);
    glDeleteShader(shader);
    glUseProgram(program_);

    glGenVertexArrays(1, &vertex_array_);
    glBindVertexArray(vertex_array_);
    glGenBuffers(1, &buffer_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    glBufferData(GL_ARRAY_BUFFER, 64, nullptr, GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glEnableClientState(GL_COLOR_ARRAY);
    glGenBuffers(1, &pixel_buffer_);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, pixel_buffer_);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, pixel_buffer_);

    glGenTextures(1, &texture_);
    glGenSamplers(1, &sampler_);
    glSamplerParameteri(sampler_, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glSamplerParameteri(sampler_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    for (GLuint unit = 0; unit < 2; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture_);
        glBindSampler(unit, sampler_);
        glEnable(GL_TEXTURE_2D);
    }
    glActiveTexture(GL_TEXTURE3);
}

void HostileState::setRasterState() {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_ZERO, GL_ONE, GL_DST_COLOR, GL_CONSTANT_ALPHA);
    glBlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_MAX);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_NEVER, 3, 0x55);
    glStencilMask(0x0F);
    glEnable(GL_ALPHA_TEST);
    glAlphaFunc(GL_NEVER, 0.5F);
    glEnable(GL_SCISSOR_TEST);
    glScissor(3, 2, 1, 1);
    glViewport(1, 2, 3, 4);
    glDepthRange(0.25, 0.5);
    glDepthFunc(GL_NEVER);
    glDepthMask(GL_FALSE);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT_AND_BACK);
    glPolygonMode(GL_FRONT, GL_LINE);
    glPolygonMode(GL_BACK, GL_POINT);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(100.0F, 100.0F);
    glEnable(GL_POLYGON_STIPPLE);
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(GL_CLEAR);
    glEnable(GL_RASTERIZER_DISCARD);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
    glEnable(GL_SAMPLE_MASK);
    glSampleMaski(0, 0);
    glEnable(GL_PRIMITIVE_RESTART);
    glPrimitiveRestartIndex(0);
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_TRUE);
    glEnable(GL_FOG);
    glEnable(GL_LIGHTING);
    for (GLenum plane = 0; plane < 6; ++plane) {
        const GLdouble nothing[4] = {0.0, 0.0, 0.0, -1.0};
        glClipPlane(GL_CLIP_PLANE0 + plane, nothing);
        glEnable(GL_CLIP_PLANE0 + plane);
    }
}

void HostileState::setPixelState() {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 19);
    glPixelStorei(GL_PACK_SKIP_ROWS, 5);
    glPixelTransferf(GL_RED_SCALE, 0.25F);
    glPixelTransferf(GL_GREEN_BIAS, 0.5F);
    glPixelTransferf(GL_DEPTH_SCALE, 0.5F);
    glPixelTransferf(GL_DEPTH_BIAS, 0.25F);
    glPixelZoom(2.0F, -1.0F);
}

void HostileState::setMatricesAndStacks() {
    // Both attribute stacks full: whoever pushes gets GL_STACK_OVERFLOW.
    GLint depth = 0;
    glGetIntegerv(GL_MAX_ATTRIB_STACK_DEPTH, &depth);
    for (GLint i = 0; i < depth; ++i) {
        glPushAttrib(GL_CURRENT_BIT);
    }
    glGetIntegerv(GL_MAX_CLIENT_ATTRIB_STACK_DEPTH, &depth);
    for (GLint i = 0; i < depth; ++i) {
        glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
    }
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glScalef(0.0F, 7.0F, 1.0F);
    glMatrixMode(GL_TEXTURE);
    glTranslatef(1.0F, 2.0F, 3.0F);
    glColor4f(0.1F, 0.2F, 0.3F, 0.4F);
    glNormal3f(1.0F, 0.0F, 0.0F);
}

HostileState::~HostileState() {
    glUseProgram(0);
    glDeleteProgram(program_);
    glBindVertexArray(0);
    glDeleteVertexArrays(1, &vertex_array_);
    glDeleteBuffers(1, &buffer_);
    glDeleteBuffers(1, &pixel_buffer_);
    glDeleteSamplers(1, &sampler_);
    glDeleteTextures(1, &texture_);
}

}  // namespace sluice::host::test
