/* SPDX-License-Identifier: MIT
 * The ends of frames, and the lives of contexts. */
#include <stddef.h>

#include "shim.h"

/* Swaps of this thread that came through GLX or EGL: tells a toolkit's swap that ends in one of them from one that does
 * not. */
static __thread unsigned swaps __attribute__((tls_model("initial-exec")));

/* Whether a context is current here: a swap without one is no frame, and needs no payload. */
static int has_context(uint32_t api) {
    static SluiceInjectHook glx = {"glXGetCurrentContext", NULL, 0, 0}, egl = {"eglGetCurrentContext", NULL, 0, 0};
    typedef void* (*Current)(void);
    const Current glx_current = api == SLUICE_INJECT_EGL ? NULL : (Current)real_of(&glx);
    const Current egl_current = api == SLUICE_INJECT_GLX ? NULL : (Current)real_of(&egl);
    return (glx_current != NULL && glx_current() != NULL) || (egl_current != NULL && egl_current() != NULL);
}

static void end_frame(uint32_t api, void* display, uintptr_t drawable, int hook) {
    if (shim_is_inside()) {
        return;
    }
    ++swaps;
    if (!has_context(api)) {
        return;
    }
    const SluiceInjectPayload* to = shim_enter_loading();
    if (to != NULL) {
        to->swap(api, display, drawable, shim_hooks[hook].name);
        shim_leave();
    }
}

void glXSwapBuffers(void* display, unsigned long drawable) {
    typedef void (*Real)(void*, unsigned long);
    const Real real = SHIM_REAL(glXSwapBuffers, Real);
    end_frame(SLUICE_INJECT_GLX, display, drawable, HOOK_glXSwapBuffers);
    if (real != NULL) {
        real(display, drawable);
    }
}

int64_t glXSwapBuffersMscOML(void* display, unsigned long drawable, int64_t target, int64_t divisor,
                             int64_t remainder) {
    typedef int64_t (*Real)(void*, unsigned long, int64_t, int64_t, int64_t);
    const Real real = SHIM_REAL(glXSwapBuffersMscOML, Real);
    end_frame(SLUICE_INJECT_GLX, display, drawable, HOOK_glXSwapBuffersMscOML);
    return real == NULL ? -1 : real(display, drawable, target, divisor, remainder);
}

unsigned eglSwapBuffers(void* display, void* surface) {
    typedef unsigned (*Real)(void*, void*);
    const Real real = SHIM_REAL(eglSwapBuffers, Real);
    end_frame(SLUICE_INJECT_EGL, display, (uintptr_t)surface, HOOK_eglSwapBuffers);
    return real == NULL ? 0 : real(display, surface);
}

#define SWAP_WITH_DAMAGE(name)                                                          \
    unsigned name(void* display, void* surface, const int32_t* rectangles, int32_t n) { \
        typedef unsigned (*Real)(void*, void*, const int32_t*, int32_t);                \
        const Real real = SHIM_REAL(name, Real);                                        \
        end_frame(SLUICE_INJECT_EGL, display, (uintptr_t)surface, HOOK_##name);         \
        return real == NULL ? 0 : real(display, surface, rectangles, n);                \
    }
SWAP_WITH_DAMAGE(eglSwapBuffersWithDamageKHR)
SWAP_WITH_DAMAGE(eglSwapBuffersWithDamageEXT)

/* A toolkit's swap ends in one of the above, which then is the end of the frame. Where it does not (a toolkit that
 * binds its driver's functions as nobody can see), the next one counts itself. They return nothing, or a truth value
 * (SDL 3). One that skips a swap, of a hidden window, is no such toolkit: it takes several in a row. */
enum { ENOUGH_MISSES = 3 };
#define TOOLKIT_SWAP(name, parameters, arguments)                   \
    int name parameters {                                           \
        typedef int(*Real) parameters;                              \
        static int counts_itself;                                   \
        const Real real = SHIM_REAL(name, Real);                    \
        if (counts_itself == ENOUGH_MISSES) {                       \
            end_frame(SLUICE_INJECT_ANY, NULL, 0, HOOK_##name);     \
        }                                                           \
        const unsigned before = swaps;                              \
        const int answer = real == NULL ? 0 : real arguments;       \
        if (swaps != before) {                                      \
            counts_itself = 0;                                      \
        } else if (real != NULL && counts_itself < ENOUGH_MISSES) { \
            ++counts_itself;                                        \
        }                                                           \
        return answer;                                              \
    }
TOOLKIT_SWAP(SDL_GL_SwapWindow, (void* window), (window))
TOOLKIT_SWAP(SDL_GL_SwapBuffers, (void), ())
TOOLKIT_SWAP(glutSwapBuffers, (void), ())

static void made_current(void) {
    const SluiceInjectPayload* to = shim_enter();
    if (to != NULL) {
        to->made_current();
        shim_leave();
    }
}

int glXMakeCurrent(void* display, unsigned long drawable, void* context) {
    typedef int (*Real)(void*, unsigned long, void*);
    const Real real = SHIM_REAL(glXMakeCurrent, Real);
    const int answer = real == NULL ? 0 : real(display, drawable, context);
    made_current();
    return answer;
}

#define MAKE_CONTEXT_CURRENT(name)                                                   \
    int name(void* display, unsigned long draw, unsigned long read, void* context) { \
        typedef int (*Real)(void*, unsigned long, unsigned long, void*);             \
        const Real real = SHIM_REAL(name, Real);                                     \
        const int answer = real == NULL ? 0 : real(display, draw, read, context);    \
        made_current();                                                              \
        return answer;                                                               \
    }
MAKE_CONTEXT_CURRENT(glXMakeContextCurrent)
MAKE_CONTEXT_CURRENT(glXMakeCurrentReadSGI)

unsigned eglMakeCurrent(void* display, void* draw, void* read, void* context) {
    typedef unsigned (*Real)(void*, void*, void*, void*);
    const Real real = SHIM_REAL(eglMakeCurrent, Real);
    const unsigned answer = real == NULL ? 0 : real(display, draw, read, context);
    made_current();
    return answer;
}

unsigned eglReleaseThread(void) {
    typedef unsigned (*Real)(void);
    const Real real = SHIM_REAL(eglReleaseThread, Real);
    const unsigned answer = real == NULL ? 0 : real();
    made_current();
    return answer;
}

static void* created(uint32_t api, void* context) {
    const SluiceInjectPayload* to = context == NULL ? NULL : shim_enter();
    if (to != NULL) {
        to->context_created(api, context);
        shim_leave();
    }
    return context;
}

void* glXCreateContext(void* display, void* visual, void* share, int direct) {
    typedef void* (*Real)(void*, void*, void*, int);
    const Real real = SHIM_REAL(glXCreateContext, Real);
    return real == NULL ? NULL : created(SLUICE_INJECT_GLX, real(display, visual, share, direct));
}

void* glXCreateNewContext(void* display, void* config, int type, void* share, int direct) {
    typedef void* (*Real)(void*, void*, int, void*, int);
    const Real real = SHIM_REAL(glXCreateNewContext, Real);
    return real == NULL ? NULL : created(SLUICE_INJECT_GLX, real(display, config, type, share, direct));
}

void* glXCreateContextAttribsARB(void* display, void* config, void* share, int direct, const int* attributes) {
    typedef void* (*Real)(void*, void*, void*, int, const int*);
    const Real real = SHIM_REAL(glXCreateContextAttribsARB, Real);
    return real == NULL ? NULL : created(SLUICE_INJECT_GLX, real(display, config, share, direct, attributes));
}

void* eglCreateContext(void* display, void* config, void* share, const int32_t* attributes) {
    typedef void* (*Real)(void*, void*, void*, const int32_t*);
    const Real real = SHIM_REAL(eglCreateContext, Real);
    return real == NULL ? NULL : created(SLUICE_INJECT_EGL, real(display, config, share, attributes));
}

static void destroys(uint32_t api, void* display, void* context) {
    const SluiceInjectPayload* to = shim_enter();
    if (to != NULL) {
        to->destroy_context(api, display, context);
        shim_leave();
    }
}

void glXDestroyContext(void* display, void* context) {
    typedef void (*Real)(void*, void*);
    const Real real = SHIM_REAL(glXDestroyContext, Real);
    destroys(SLUICE_INJECT_GLX, display, context);
    if (real != NULL) {
        real(display, context);
    }
}

unsigned eglDestroyContext(void* display, void* context) {
    typedef unsigned (*Real)(void*, void*);
    const Real real = SHIM_REAL(eglDestroyContext, Real);
    destroys(SLUICE_INJECT_EGL, display, context);
    return real == NULL ? 0 : real(display, context);
}

unsigned eglTerminate(void* display) {
    typedef unsigned (*Real)(void*);
    const Real real = SHIM_REAL(eglTerminate, Real);
    const SluiceInjectPayload* to = shim_enter();
    if (to != NULL) {
        to->display_ended(display);
        shim_leave();
    }
    return real == NULL ? 0 : real(display);
}
