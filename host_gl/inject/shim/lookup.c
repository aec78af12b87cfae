/* SPDX-License-Identifier: MIT
 * The ways by which a program asks for a function by name. Whoever asks for a hooked one gets the hook, if there is a
 * real one behind it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stddef.h>
#include <string.h>
#include <sys/auxv.h>

#include "shim.h"

/* The library, or the program itself, that an address lies in; NULL for none. */
static const void* object_of(const void* address) {
    Dl_info object;
    return address != NULL && dladdr(address, &object) != 0 ? object.dli_fbase : NULL;
}

static const void* program_itself(void) {
    const void* headers = NULL;
    const unsigned long at = getauxval(AT_PHDR);
    memcpy(&headers, &at, sizeof(headers));
    return object_of(headers);
}

/* What `caller` gets instead of `found`. A program, or another preloaded library, may stand in front of a function as
 * the shim does, and call what it looks up: whatever the shim itself would pass the call on to must not be handed the
 * shim. */
static void* hooked(int hook, void* found, uint32_t via, const void* caller) {
    if (found == NULL) {
        return NULL;
    }
    if (is_ours(found)) {
        /* The shim's own symbol answers for a library that was never loaded. */
        void* real = as_address(real_of(&shim_hooks[hook]));
        return real == NULL ? NULL : object_of(real) == object_of(caller) ? real : found;
    }
    const void* there = object_of(found);
    if (there != NULL && (there == object_of(caller) || there == program_itself())) {
        return found; /* it leads to a hook, or on, by itself */
    }
    SluiceInjectFunction none = NULL;
    (void)__atomic_compare_exchange_n(&shim_hooks[hook].real, &none, as_function(found), 0, __ATOMIC_ACQ_REL,
                                      __ATOMIC_RELAXED);
    const void* next = object_of(as_address(real_of(&shim_hooks[hook])));
    if (next != NULL && next == object_of(caller)) {
        return found;
    }
    /* Inside the payload, too: what a library that it shares with the program looks up there the program will call. */
    if (!shim_is_inside()) {
        shim_note_route(hook, via);
    }
    return shim_wrapper(hook);
}

/* RTLD_DEFAULT means the scope of whoever asks, and the shim's begins with itself. */
static void* scope(void* handle) {
    return handle == RTLD_DEFAULT ? dlopen(NULL, RTLD_LAZY | RTLD_NOLOAD) : handle;
}

/* The real dlsym finds out who calls it by its return address, which must stay the program's: these two end in a jump,
 * for names that are not hooked and for RTLD_NEXT, with which other preloaded libraries look for what comes behind
 * them. */
__attribute__((optimize("O2"))) void* dlsym(void* handle, const char* name) {
    const RealDlsym real = real_dlsym();
    const int hook = handle == RTLD_NEXT ? -1 : shim_find_hook(name);
    if (hook < 0) {
        return real(handle, name);
    }
    return hooked(hook, real(scope(handle), name), SLUICE_INJECT_VIA_DLSYM, __builtin_return_address(0));
}

__attribute__((optimize("O2"))) void* dlvsym(void* handle, const char* name, const char* version) {
    const RealDlvsym real = real_dlvsym();
    const int hook = handle == RTLD_NEXT ? -1 : shim_find_hook(name);
    if (hook < 0) {
        return real(handle, name, version);
    }
    return hooked(hook, real(scope(handle), name, version), SLUICE_INJECT_VIA_DLSYM, __builtin_return_address(0));
}

typedef void* (*GetProcAddress)(const char* name);

static void* get(GetProcAddress real, const char* name, const void* caller) {
    void* found = real == NULL ? NULL : real(name);
    const int hook = shim_find_hook(name);
    return hook < 0 ? found : hooked(hook, found, SLUICE_INJECT_VIA_GET_PROC_ADDRESS, caller);
}

#define GET_PROC_ADDRESS(way)                                                          \
    void* way(const char* name) {                                                      \
        return get(SHIM_REAL(way, GetProcAddress), name, __builtin_return_address(0)); \
    }
GET_PROC_ADDRESS(glXGetProcAddress)
GET_PROC_ADDRESS(glXGetProcAddressARB)
GET_PROC_ADDRESS(eglGetProcAddress)
GET_PROC_ADDRESS(SDL_GL_GetProcAddress)
