/* SPDX-License-Identifier: MIT
 * What the shim's files share: the hooks, the guard, the payload. */
#ifndef SLUICE_INJECT_SHIM_H
#define SLUICE_INJECT_SHIM_H

#include "real.h"

/* Every function that the shim exports and that a program may ask for by name. */
/* clang-format off */
#define SHIM_HOOKS(X) \
    X(glXSwapBuffers) X(glXSwapBuffersMscOML) X(eglSwapBuffers) X(eglSwapBuffersWithDamageKHR) \
    X(eglSwapBuffersWithDamageEXT) X(SDL_GL_SwapWindow) X(SDL_GL_SwapBuffers) X(glutSwapBuffers) \
    X(glXMakeCurrent) X(glXMakeContextCurrent) X(glXMakeCurrentReadSGI) X(eglMakeCurrent) X(glXDestroyContext) \
    X(eglDestroyContext) X(glXGetProcAddress) X(glXGetProcAddressARB) X(eglGetProcAddress) \
    X(SDL_GL_GetProcAddress) X(glMatrixMode) X(glLoadIdentity) X(glLoadMatrixf) X(glLoadMatrixd) \
    X(glLoadTransposeMatrixf) X(glLoadTransposeMatrixd) X(glMultMatrixf) X(glMultMatrixd) \
    X(glMultTransposeMatrixf) X(glMultTransposeMatrixd) X(glFrustum) X(glFrustumf) X(glOrtho) X(glOrthof) \
    X(glRotatef) X(glRotated) X(glTranslatef) X(glTranslated) X(glScalef) X(glScaled) X(glPushMatrix) \
    X(glPopMatrix) X(glUseProgram) X(glUseProgramObjectARB) X(glUniformMatrix4fv) X(glUniformMatrix4fvARB) \
    X(glProgramUniformMatrix4fv) X(glBindFramebuffer) X(glBindFramebufferEXT) X(glNewList) X(glEndList) \
    X(glCallList) X(glCallLists) X(glBegin) X(glEnd) X(glClear) X(glViewport) X(glClearBufferfi) X(glClearBufferfv) X(glClearNamedFramebufferfi) \
    X(glClearNamedFramebufferfv) X(glGetError) X(glDrawArrays) \
    X(glDrawArraysEXT) X(glDrawElements) X(glDrawRangeElements) X(glDrawRangeElementsEXT) \
    X(glDrawElementsBaseVertex) X(glDrawRangeElementsBaseVertex) X(glDrawArraysInstanced) \
    X(glDrawElementsInstanced) X(glDrawElementsInstancedBaseVertex) X(glMultiDrawArrays) \
    X(glMultiDrawElements) X(glDrawArraysIndirect) X(glDrawElementsIndirect) X(glMultiDrawArraysIndirect) \
    X(glMultiDrawElementsIndirect) X(glPopAttrib) X(glLinkProgram) X(glLinkProgramARB) X(glProgramBinary) \
    X(glDeleteProgram) X(glDeleteObjectARB) X(glDeleteFramebuffers) X(glDeleteFramebuffersEXT) \
    X(glXCreateContext) X(glXCreateNewContext) X(glXCreateContextAttribsARB) X(eglCreateContext) \
    X(eglTerminate) X(eglReleaseThread) \
    X(glDrawArraysInstancedARB) X(glDrawArraysInstancedEXT) X(glDrawElementsInstancedARB) \
    X(glDrawElementsInstancedEXT) X(glMultiDrawArraysEXT) X(glMultiDrawElementsEXT) \
    X(glMultiDrawElementsBaseVertex) X(glDrawArraysInstancedBaseInstance) \
    X(glDrawElementsInstancedBaseInstance) X(glDrawElementsInstancedBaseVertexBaseInstance) \
    X(glMultiDrawArraysIndirectCount) X(glMultiDrawElementsIndirectCount) X(glDrawTransformFeedback) \
    X(glDrawTransformFeedbackStream) X(glDrawTransformFeedbackInstanced) \
    X(glDrawTransformFeedbackStreamInstanced) X(glRectd) X(glRectdv) X(glRectf) X(glRectfv) X(glRecti) \
    X(glRectiv) X(glRects) X(glRectsv) X(glBitmap) X(glDrawPixels) X(glCopyPixels) X(glEvalMesh1) \
    X(glEvalMesh2) \
    X(glBindBufferBase) X(glBindBufferRange) X(glBindBuffersBase) \
    X(glBindBuffersRange) X(glBufferData) X(glBufferSubData) X(glNamedBufferData) X(glNamedBufferSubData) \
    X(glUniformBlockBinding) X(glUnmapBuffer) X(glUnmapNamedBuffer)
/* clang-format on */

#define SHIM_ENUMERATE(name) HOOK_##name,
enum { SHIM_HOOKS(SHIM_ENUMERATE) HOOK_COUNT };
#undef SHIM_ENUMERATE

extern SluiceInjectHook shim_hooks[HOOK_COUNT];

/* The hook of that name, -1 if there is none. */
int shim_find_hook(const char* name);
/* The exported function of a hook. */
void* shim_wrapper(int hook);
/* Notes how a program came by a hook's address. */
void shim_note_route(int hook, uint32_t via);

/* The payload, with this thread's guard held; NULL if there is none, or if the call comes from inside it. */
const SluiceInjectPayload* shim_enter(void);
void shim_leave(void);
int shim_is_inside(void);
/* The same, after loading it if this process has not tried yet. */
const SluiceInjectPayload* shim_enter_loading(void);

/* Between glBegin and glEnd nothing may be asked of OpenGL. */
extern __thread int shim_in_primitive __attribute__((tls_model("initial-exec")));

/* What SLUICE_INJECT said; never NULL. */
const char* shim_settings(void);

/* Counts the call and gives the real function as `type`. */
#define SHIM_REAL(name, type) ((type)shim_called(HOOK_##name))
SluiceInjectFunction shim_called(int hook);

#endif
