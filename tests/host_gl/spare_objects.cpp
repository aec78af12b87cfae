// SPDX-License-Identifier: MIT
#include "spare_objects.hpp"

#include <initializer_list>

namespace sluice::host::test {
namespace {

GLuint makeProgram() {
    const GLuint shader = glCreateShader(GL_VERTEX_SHADER);
    const char* source = "#version 120\nvoid main() { gl_Position = gl_Vertex; }\n";
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader);
    glLinkProgram(program);
    glDeleteShader(shader);
    return program;
}

/// A name becomes an object when it is first bound.
GLuint makeTexture(GLenum target) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(target, texture);
    if (target == GL_TEXTURE_2D) {
        glTexStorage2D(target, 1, GL_R8, 4, 4);
    }
    glBindTexture(target, 0);
    return texture;
}

GLuint makeFramebuffer() {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    return framebuffer;
}

}  // namespace

SpareObjects::SpareObjects()
    : texture_2d(makeTexture(GL_TEXTURE_2D)),
      texture_3d(makeTexture(GL_TEXTURE_3D)),
      texture_cube(makeTexture(GL_TEXTURE_CUBE_MAP)),
      framebuffer(makeFramebuffer()),
      // Bound from here on: changing from one framebuffer object to another moves one line, whereas the default
      // framebuffer would also differ in its draw and read buffers.
      bound_framebuffer(makeFramebuffer()),
      program(makeProgram()) {
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, 256, nullptr, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glGenRenderbuffers(1, &renderbuffer);
    glGenSamplers(1, &sampler);
    glGenVertexArrays(1, &vertex_array);
    glGenQueries(1, &query);
}

SpareObjects::~SpareObjects() {
    glDeleteProgram(program);
    glDeleteQueries(1, &query);
    glDeleteVertexArrays(1, &vertex_array);
    glDeleteSamplers(1, &sampler);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteFramebuffers(1, &bound_framebuffer);
    glDeleteRenderbuffers(1, &renderbuffer);
    glDeleteBuffers(1, &buffer);
    for (const GLuint texture : {texture_2d, texture_3d, texture_cube}) {
        glDeleteTextures(1, &texture);
    }
}

}  // namespace sluice::host::test
