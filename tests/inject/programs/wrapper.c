/* SPDX-License-Identifier: MIT
 * What stands in front of eglSwapBuffers besides the shim: an overlay that the user preloads, or the program itself.
 * WRAPPER=handle asks libEGL for the real one, anything else RTLD_NEXT. */
#define _GNU_SOURCE
#include <EGL/egl.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int calls;

__attribute__((visibility("default"))) EGLBoolean eglSwapBuffers(EGLDisplay display, EGLSurface surface) {
    static EGLBoolean (*real)(EGLDisplay, EGLSurface);
    if (real == NULL) {
        const char* way = getenv("WRAPPER");
        void* const found = way != NULL && strcmp(way, "handle") == 0
                                ? dlsym(dlopen("libEGL.so.1", RTLD_NOW), "eglSwapBuffers")
                                : dlsym(RTLD_NEXT, "eglSwapBuffers");
        memcpy(&real, &found, sizeof(real));
    }
    ++calls;
    return real == NULL ? EGL_FALSE : real(display, surface);
}

__attribute__((destructor)) static void tell(void) {
    if (calls > 0) {
        (void)printf("wrapped %d\n", calls);
    }
}
