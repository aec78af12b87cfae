/* SPDX-License-Identifier: MIT
 * OpenGL calls that tell where the camera is and what is drawn with it. Each passes on what it was given, whatever the
 * payload makes of it. */
#include <stddef.h>
#include <stdint.h>

#include "shim.h"

/* Does `what` with the payload, unless there is none or OpenGL must not be asked anything now. */
#define TELL(what)                                                               \
    do {                                                                         \
        const SluiceInjectPayload* to = shim_in_primitive ? NULL : shim_enter(); \
        if (to != NULL) {                                                        \
            to->what;                                                            \
            shim_leave();                                                        \
        }                                                                        \
    } while (0)

/* A function without a result: told before the real call, or after it. */
#define BEFORE(name, parameters, arguments, what) \
    void name parameters {                        \
        typedef void(*Real) parameters;           \
        const Real real = SHIM_REAL(name, Real);  \
        TELL(what);                               \
        if (real != NULL) {                       \
            real arguments;                       \
        }                                         \
    }
#define AFTER(name, parameters, arguments, what) \
    void name parameters {                       \
        typedef void(*Real) parameters;          \
        const Real real = SHIM_REAL(name, Real); \
        if (real != NULL) {                      \
            real arguments;                      \
        }                                        \
        TELL(what);                              \
    }

/* Both, for what changes under way. */
#define AROUND(name, parameters, arguments, before, after) \
    void name parameters {                                 \
        typedef void(*Real) parameters;                    \
        const Real real = SHIM_REAL(name, Real);           \
        TELL(before);                                      \
        if (real != NULL) {                                \
            real arguments;                                \
        }                                                  \
        TELL(after);                                       \
    }

AFTER(glMatrixMode, (uint32_t mode), (mode), matrix_mode(mode))

#define MATRIX(name, parameters, arguments) AFTER(name, parameters, arguments, matrix_changed())
MATRIX(glLoadIdentity, (void), ())
MATRIX(glLoadMatrixf, (const float* matrix), (matrix))
MATRIX(glLoadMatrixd, (const double* matrix), (matrix))
MATRIX(glLoadTransposeMatrixf, (const float* matrix), (matrix))
MATRIX(glLoadTransposeMatrixd, (const double* matrix), (matrix))
MATRIX(glMultMatrixf, (const float* matrix), (matrix))
MATRIX(glMultMatrixd, (const double* matrix), (matrix))
MATRIX(glMultTransposeMatrixf, (const float* matrix), (matrix))
MATRIX(glMultTransposeMatrixd, (const double* matrix), (matrix))
MATRIX(glFrustum, (double left, double right, double bottom, double top, double z_near, double z_far),
       (left, right, bottom, top, z_near, z_far))
MATRIX(glFrustumf, (float left, float right, float bottom, float top, float z_near, float z_far),
       (left, right, bottom, top, z_near, z_far))
MATRIX(glOrtho, (double left, double right, double bottom, double top, double z_near, double z_far),
       (left, right, bottom, top, z_near, z_far))
MATRIX(glOrthof, (float left, float right, float bottom, float top, float z_near, float z_far),
       (left, right, bottom, top, z_near, z_far))
MATRIX(glRotatef, (float angle, float x, float y, float z), (angle, x, y, z))
MATRIX(glTranslatef, (float x, float y, float z), (x, y, z))
MATRIX(glScalef, (float x, float y, float z), (x, y, z))
MATRIX(glRotated, (double angle, double x, double y, double z), (angle, x, y, z))
MATRIX(glTranslated, (double x, double y, double z), (x, y, z))
MATRIX(glScaled, (double x, double y, double z), (x, y, z))
AFTER(glPopMatrix, (void), (), matrix_popped())
BEFORE(glPushMatrix, (void), (), matrix_pushed())
AFTER(glViewport, (int32_t x, int32_t y, int32_t width, int32_t height), (x, y, width, height), viewport_changed())
AFTER(glPopAttrib, (void), (), attributes_popped())

AFTER(glUseProgram, (uint32_t program), (program), use_program(program))
AFTER(glUseProgramObjectARB, (uint32_t program), (program), use_program(program))

#define UNIFORM(name)                                                                     \
    AFTER(name, (int32_t location, int32_t count, uint8_t transpose, const float* value), \
          (location, count, transpose, value), uniform_matrix(0, location, count, transpose, value))
UNIFORM(glUniformMatrix4fv)
UNIFORM(glUniformMatrix4fvARB)
AFTER(glProgramUniformMatrix4fv,
      (uint32_t program, int32_t location, int32_t count, uint8_t transpose, const float* value),
      (program, location, count, transpose, value), uniform_matrix(program, location, count, transpose, value))

AFTER(glLinkProgram, (uint32_t program), (program), program_linked(program))
AFTER(glLinkProgramARB, (uint32_t program), (program), program_linked(program))
AFTER(glProgramBinary, (uint32_t program, uint32_t format, const void* binary, int32_t length),
      (program, format, binary, length), program_linked(program))
AFTER(glDeleteProgram, (uint32_t program), (program), program_deleted(program))
AFTER(glDeleteObjectARB, (uint32_t object), (object), program_deleted(object))

AFTER(glDeleteFramebuffers, (int32_t count, const uint32_t* names), (count, names), framebuffers_deleted(count, names))
AFTER(glDeleteFramebuffersEXT, (int32_t count, const uint32_t* names), (count, names),
      framebuffers_deleted(count, names))

/* Matrices in uniform blocks: it is said that they may have changed, and the payload looks at the next draw. Persistent
 * mappings are written without a call; what is bound before a draw is looked at, too. */
#define BUFFER(name, parameters, arguments, target) \
    void name parameters {                          \
        typedef void(*Real) parameters;             \
        const Real real = SHIM_REAL(name, Real);    \
        if (real != NULL) {                         \
            real arguments;                         \
        }                                           \
        if (holds_blocks(target)) {                 \
            TELL(blocks_changed());                 \
        }                                           \
    }
enum { UNIFORM_BUFFER = 0x8A11, COPY_WRITE_BUFFER = 0x8F37 };
static int holds_blocks(uint32_t target) {
    return target == UNIFORM_BUFFER || target == COPY_WRITE_BUFFER;
}
BUFFER(glBindBufferBase, (uint32_t target, uint32_t index, uint32_t buffer), (target, index, buffer), target)
BUFFER(glBindBufferRange, (uint32_t target, uint32_t index, uint32_t buffer, intptr_t offset, intptr_t size),
       (target, index, buffer, offset, size), target)
BUFFER(glBindBuffersBase, (uint32_t target, uint32_t first, int32_t count, const uint32_t* buffers),
       (target, first, count, buffers), target)
BUFFER(glBindBuffersRange,
       (uint32_t target, uint32_t first, int32_t count, const uint32_t* buffers, const intptr_t* offsets,
        const intptr_t* sizes),
       (target, first, count, buffers, offsets, sizes), target)
BUFFER(glBufferData, (uint32_t target, intptr_t size, const void* data, uint32_t usage), (target, size, data, usage),
       target)
BUFFER(glBufferSubData, (uint32_t target, intptr_t offset, intptr_t size, const void* data),
       (target, offset, size, data), target)
BUFFER(glNamedBufferData, (uint32_t buffer, intptr_t size, const void* data, uint32_t usage),
       (buffer, size, data, usage), UNIFORM_BUFFER)
BUFFER(glNamedBufferSubData, (uint32_t buffer, intptr_t offset, intptr_t size, const void* data),
       (buffer, offset, size, data), UNIFORM_BUFFER)
BUFFER(glUniformBlockBinding, (uint32_t program, uint32_t block, uint32_t point), (program, block, point),
       UNIFORM_BUFFER)
#define UNMAP(name, parameter, target)                            \
    uint8_t name(uint32_t parameter) {                            \
        typedef uint8_t (*Real)(uint32_t);                        \
        const Real real = SHIM_REAL(name, Real);                  \
        const uint8_t whole = real == NULL ? 0 : real(parameter); \
        if (holds_blocks(target)) {                               \
            TELL(blocks_changed());                               \
        }                                                         \
        return whole;                                             \
    }
UNMAP(glUnmapBuffer, target, target)
UNMAP(glUnmapNamedBuffer, buffer, UNIFORM_BUFFER)

BEFORE(glBindFramebuffer, (uint32_t target, uint32_t framebuffer), (target, framebuffer),
       bind_framebuffer(target, framebuffer))
BEFORE(glBindFramebufferEXT, (uint32_t target, uint32_t framebuffer), (target, framebuffer),
       bind_framebuffer(target, framebuffer))

AFTER(glNewList, (uint32_t list, uint32_t mode), (list, mode), list_mode(mode))
AFTER(glEndList, (void), (), list_mode(0))
AROUND(glCallList, (uint32_t list), (list), draw(0), list_called())
AROUND(glCallLists, (int32_t count, uint32_t type, const void* lists), (count, type, lists), draw(0), list_called())
BEFORE(glClear, (uint32_t mask), (mask), clear(mask))

/* Their buffer as glClear's bit; 0: it is no depth. */
static uint32_t depth_bit(uint32_t buffer) {
    return buffer == 0x1801 /* GL_DEPTH */ || buffer == 0x84F9 /* GL_DEPTH_STENCIL */ ? 0x0100U : 0U;
}
BEFORE(glClearBufferfv, (uint32_t buffer, int32_t which, const float* value), (buffer, which, value),
       clear(depth_bit(buffer)))
BEFORE(glClearBufferfi, (uint32_t buffer, int32_t which, float depth, int32_t stencil), (buffer, which, depth, stencil),
       clear(depth_bit(buffer)))
BEFORE(glClearNamedFramebufferfv, (uint32_t framebuffer, uint32_t buffer, int32_t which, const float* value),
       (framebuffer, buffer, which, value), clear_of(framebuffer, depth_bit(buffer)))
BEFORE(glClearNamedFramebufferfi, (uint32_t framebuffer, uint32_t buffer, int32_t which, float depth, int32_t stencil),
       (framebuffer, buffer, which, depth, stencil), clear_of(framebuffer, depth_bit(buffer)))

void glBegin(uint32_t mode) {
    typedef void (*Real)(uint32_t);
    const Real real = SHIM_REAL(glBegin, Real);
    TELL(draw(0));
    if (!shim_is_inside()) {
        shim_in_primitive = 1;
    }
    if (real != NULL) {
        real(mode);
    }
}

void glEnd(void) {
    typedef void (*Real)(void);
    const Real real = SHIM_REAL(glEnd, Real);
    if (real != NULL) {
        real();
    }
    if (!shim_is_inside()) {
        shim_in_primitive = 0;
    }
}

uint32_t glGetError(void) {
    typedef uint32_t (*Real)(void);
    const Real real = SHIM_REAL(glGetError, Real);
    uint32_t kept = 0;
    TELL(take_error(&kept));
    return kept != 0 || real == NULL ? kept : real();
}

static uint32_t product(int32_t a, int32_t b) {
    const int64_t vertices = a > 0 && b > 0 ? (int64_t)a * b : 0;
    return vertices > UINT32_MAX ? UINT32_MAX : (uint32_t)vertices;
}

static uint32_t sum(const int32_t* counts, int32_t n) {
    uint32_t vertices = 0;
    for (int32_t i = 0; counts != NULL && i < n; ++i) {
        vertices += product(counts[i], 1);
    }
    return vertices;
}

BEFORE(glDrawArrays, (uint32_t mode, int32_t first, int32_t count), (mode, first, count), draw(product(count, 1)))
BEFORE(glDrawArraysEXT, (uint32_t mode, int32_t first, int32_t count), (mode, first, count), draw(product(count, 1)))
BEFORE(glDrawElements, (uint32_t mode, int32_t count, uint32_t type, const void* indices), (mode, count, type, indices),
       draw(product(count, 1)))
BEFORE(glDrawRangeElements,
       (uint32_t mode, uint32_t start, uint32_t end, int32_t count, uint32_t type, const void* indices),
       (mode, start, end, count, type, indices), draw(product(count, 1)))
BEFORE(glDrawRangeElementsEXT,
       (uint32_t mode, uint32_t start, uint32_t end, int32_t count, uint32_t type, const void* indices),
       (mode, start, end, count, type, indices), draw(product(count, 1)))
BEFORE(glDrawElementsBaseVertex, (uint32_t mode, int32_t count, uint32_t type, const void* indices, int32_t base),
       (mode, count, type, indices, base), draw(product(count, 1)))
BEFORE(glDrawRangeElementsBaseVertex,
       (uint32_t mode, uint32_t start, uint32_t end, int32_t count, uint32_t type, const void* indices, int32_t base),
       (mode, start, end, count, type, indices, base), draw(product(count, 1)))
BEFORE(glDrawArraysInstanced, (uint32_t mode, int32_t first, int32_t count, int32_t instances),
       (mode, first, count, instances), draw(product(count, instances)))
BEFORE(glDrawElementsInstanced, (uint32_t mode, int32_t count, uint32_t type, const void* indices, int32_t instances),
       (mode, count, type, indices, instances), draw(product(count, instances)))
BEFORE(glDrawElementsInstancedBaseVertex,
       (uint32_t mode, int32_t count, uint32_t type, const void* indices, int32_t instances, int32_t base),
       (mode, count, type, indices, instances, base), draw(product(count, instances)))
BEFORE(glMultiDrawArrays, (uint32_t mode, const int32_t* first, const int32_t* counts, int32_t draws),
       (mode, first, counts, draws), draw(sum(counts, draws)))
BEFORE(glMultiDrawElements,
       (uint32_t mode, const int32_t* counts, uint32_t type, const void* const* indices, int32_t draws),
       (mode, counts, type, indices, draws), draw(sum(counts, draws)))
BEFORE(glDrawArraysIndirect, (uint32_t mode, const void* where), (mode, where), draw(0))
BEFORE(glDrawElementsIndirect, (uint32_t mode, uint32_t type, const void* where), (mode, type, where), draw(0))
BEFORE(glMultiDrawArraysIndirect, (uint32_t mode, const void* where, int32_t draws, int32_t stride),
       (mode, where, draws, stride), draw(0))
BEFORE(glMultiDrawElementsIndirect, (uint32_t mode, uint32_t type, const void* where, int32_t draws, int32_t stride),
       (mode, type, where, draws, stride), draw(0))

/* Extensions' names of the above, which lookups by name go by. */
BEFORE(glDrawArraysInstancedARB, (uint32_t mode, int32_t first, int32_t count, int32_t instances),
       (mode, first, count, instances), draw(product(count, instances)))
BEFORE(glDrawArraysInstancedEXT, (uint32_t mode, int32_t first, int32_t count, int32_t instances),
       (mode, first, count, instances), draw(product(count, instances)))
BEFORE(glDrawElementsInstancedARB,
       (uint32_t mode, int32_t count, uint32_t type, const void* indices, int32_t instances),
       (mode, count, type, indices, instances), draw(product(count, instances)))
BEFORE(glDrawElementsInstancedEXT,
       (uint32_t mode, int32_t count, uint32_t type, const void* indices, int32_t instances),
       (mode, count, type, indices, instances), draw(product(count, instances)))
BEFORE(glMultiDrawArraysEXT, (uint32_t mode, const int32_t* first, const int32_t* counts, int32_t draws),
       (mode, first, counts, draws), draw(sum(counts, draws)))
BEFORE(glMultiDrawElementsEXT,
       (uint32_t mode, const int32_t* counts, uint32_t type, const void* const* indices, int32_t draws),
       (mode, counts, type, indices, draws), draw(sum(counts, draws)))

BEFORE(glMultiDrawElementsBaseVertex,
       (uint32_t mode, const int32_t* counts, uint32_t type, const void* const* indices, int32_t draws,
        const int32_t* bases),
       (mode, counts, type, indices, draws, bases), draw(sum(counts, draws)))
BEFORE(glDrawArraysInstancedBaseInstance,
       (uint32_t mode, int32_t first, int32_t count, int32_t instances, uint32_t base),
       (mode, first, count, instances, base), draw(product(count, instances)))
BEFORE(glDrawElementsInstancedBaseInstance,
       (uint32_t mode, int32_t count, uint32_t type, const void* indices, int32_t instances, uint32_t base),
       (mode, count, type, indices, instances, base), draw(product(count, instances)))
BEFORE(glDrawElementsInstancedBaseVertexBaseInstance,
       (uint32_t mode, int32_t count, uint32_t type, const void* indices, int32_t instances, int32_t vertex,
        uint32_t base),
       (mode, count, type, indices, instances, vertex, base), draw(product(count, instances)))
BEFORE(glMultiDrawArraysIndirectCount, (uint32_t mode, const void* where, intptr_t draws, int32_t most, int32_t stride),
       (mode, where, draws, most, stride), draw(0))
BEFORE(glMultiDrawElementsIndirectCount,
       (uint32_t mode, uint32_t type, const void* where, intptr_t draws, int32_t most, int32_t stride),
       (mode, type, where, draws, most, stride), draw(0))
BEFORE(glDrawTransformFeedback, (uint32_t mode, uint32_t feedback), (mode, feedback), draw(0))
BEFORE(glDrawTransformFeedbackStream, (uint32_t mode, uint32_t feedback, uint32_t stream), (mode, feedback, stream),
       draw(0))
BEFORE(glDrawTransformFeedbackInstanced, (uint32_t mode, uint32_t feedback, int32_t instances),
       (mode, feedback, instances), draw(0))
BEFORE(glDrawTransformFeedbackStreamInstanced, (uint32_t mode, uint32_t feedback, uint32_t stream, int32_t instances),
       (mode, feedback, stream, instances), draw(0))

/* What draws without an array: bars and crosshairs, text of glutBitmapCharacter, pictures, patches. */
#define RECTANGLE(name, number)                                                           \
    BEFORE(name, (number x1, number y1, number x2, number y2), (x1, y1, x2, y2), draw(4)) \
    BEFORE(name##v, (const number* a, const number* b), (a, b), draw(4))
RECTANGLE(glRectd, double)
RECTANGLE(glRectf, float)
RECTANGLE(glRecti, int32_t)
RECTANGLE(glRects, int16_t)
BEFORE(glBitmap, (int32_t width, int32_t height, float x, float y, float dx, float dy, const uint8_t* bits),
       (width, height, x, y, dx, dy, bits), draw(0))
BEFORE(glDrawPixels, (int32_t width, int32_t height, uint32_t format, uint32_t type, const void* pixels),
       (width, height, format, type, pixels), draw(0))
BEFORE(glCopyPixels, (int32_t x, int32_t y, int32_t width, int32_t height, uint32_t what), (x, y, width, height, what),
       draw(0))
BEFORE(glEvalMesh1, (uint32_t mode, int32_t i1, int32_t i2), (mode, i1, i2), draw(0))
BEFORE(glEvalMesh2, (uint32_t mode, int32_t i1, int32_t i2, int32_t j1, int32_t j2), (mode, i1, i2, j1, j2), draw(0))
