/* SPDX-License-Identifier: MIT
 * The ways by which a program asks for a function by name. Whoever asks for a hooked one gets the hook, if there is a
 * real one behind it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

#include "shim.h"

/* What a program gets instead of `found`. */
static void* hooked(int hook, void* found, uint32_t via) {
    if (found == NULL) {
        return NULL;
    }
    if (is_ours(found)) {
        /* The shim's own symbol answers for a library that was never loaded. */
        return real_of(&shim_hooks[hook]) == NULL ? NULL : found;
    }
    SluiceInjectFunction none = NULL;
    (void)__atomic_compare_exchange_n(&shim_hooks[hook].real, &none, as_function(found), 0, __ATOMIC_ACQ_REL,
                                      __ATOMIC_RELAXED);
    shim_note_route(hook, via);
    return shim_wrapper(hook);
}

/* The real dlsym finds out who calls it by its return address, which must stay the program's: these two end in a jump,
 * for names that are not hooked and for RTLD_NEXT, with which other preloaded libraries look for what comes behind
 * them. */
__attribute__((optimize("O2"))) void* dlsym(void* handle, const char* name) {
    const RealDlsym real = real_dlsym();
    const int hook = shim_is_inside() || handle == RTLD_NEXT ? -1 : shim_find_hook(name);
    if (hook < 0) {
        return real(handle, name);
    }
    return hooked(hook, real(handle, name), SLUICE_INJECT_VIA_DLSYM);
}

__attribute__((optimize("O2"))) void* dlvsym(void* handle, const char* name, const char* version) {
    const RealDlvsym real = real_dlvsym();
    const int hook = shim_is_inside() || handle == RTLD_NEXT ? -1 : shim_find_hook(name);
    if (hook < 0) {
        return real(handle, name, version);
    }
    return hooked(hook, real(handle, name, version), SLUICE_INJECT_VIA_DLSYM);
}

typedef void* (*GetProcAddress)(const char* name);

static void* get(GetProcAddress real, const char* name) {
    void* found = real == NULL ? NULL : real(name);
    const int hook = shim_is_inside() ? -1 : shim_find_hook(name);
    return hook < 0 ? found : hooked(hook, found, SLUICE_INJECT_VIA_GET_PROC_ADDRESS);
}

void* glXGetProcAddress(const char* name) {
    return get(SHIM_REAL(glXGetProcAddress, GetProcAddress), name);
}
void* glXGetProcAddressARB(const char* name) {
    return get(SHIM_REAL(glXGetProcAddressARB, GetProcAddress), name);
}
void* eglGetProcAddress(const char* name) {
    return get(SHIM_REAL(eglGetProcAddress, GetProcAddress), name);
}
void* SDL_GL_GetProcAddress(const char* name) {
    return get(SHIM_REAL(SDL_GL_GetProcAddress, GetProcAddress), name);
}
