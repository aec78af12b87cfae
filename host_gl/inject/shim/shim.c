/* SPDX-License-Identifier: MIT
 * The table of hooks, the guard, and the loading of the payload. */
#define _GNU_SOURCE
#include "shim.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#define SHIM_NAME(name) {#name, NULL, 0, 0},
SluiceInjectHook shim_hooks[HOOK_COUNT] = {SHIM_HOOKS(SHIM_NAME)};
#undef SHIM_NAME

#define SHIM_DECLARE(name) extern void name##_address(void) __asm__(#name);
SHIM_HOOKS(SHIM_DECLARE)
#undef SHIM_DECLARE
#define SHIM_ADDRESS(name) name##_address,
static const SluiceInjectFunction wrappers[HOOK_COUNT] = {SHIM_HOOKS(SHIM_ADDRESS)};
#undef SHIM_ADDRESS

static __thread int inside __attribute__((tls_model("initial-exec")));
__thread int shim_in_primitive __attribute__((tls_model("initial-exec")));
static const SluiceInjectPayload* payload;
static int tried;

int shim_find_hook(const char* name) {
    if (name == NULL || (name[0] != 'g' && name[0] != 'e' && name[0] != 'S')) {
        return -1;
    }
    for (int i = 0; i < HOOK_COUNT; ++i) {
        if (strcmp(name, shim_hooks[i].name) == 0) {
            return i;
        }
    }
    return -1;
}

void* shim_wrapper(int hook) {
    return as_address(wrappers[hook]);
}

void shim_note_route(int hook, uint32_t via) {
    (void)__atomic_fetch_or(&shim_hooks[hook].via, via, __ATOMIC_RELAXED);
}

SluiceInjectFunction shim_called(int hook) {
    SluiceInjectHook* called = &shim_hooks[hook];
    if (!inside) {
        /* Two threads may lose a count; none needs a locked instruction per draw call. */
        const uint64_t calls = __atomic_load_n(&called->calls, __ATOMIC_RELAXED);
        __atomic_store_n(&called->calls, calls + 1, __ATOMIC_RELAXED);
    }
    return real_of(called);
}

const SluiceInjectPayload* shim_enter(void) {
    const SluiceInjectPayload* loaded = __atomic_load_n(&payload, __ATOMIC_ACQUIRE);
    if (loaded == NULL || inside) {
        return NULL;
    }
    inside = 1;
    return loaded;
}

void shim_leave(void) {
    inside = 0;
}

int shim_is_inside(void) {
    return inside;
}

/* The payload lies beside the shim. It gets no namespace of its own (dlmopen): it has to draw with the driver that the
 * program has loaded. Its symbols are its own by RTLD_LOCAL and by being linked with hidden ones. */
static const SluiceInjectPayload* load(void) {
    static const SluiceInjectShim shim = {sizeof(SluiceInjectShim), NULL, real_function, shim_hooks, HOOK_COUNT};
    static SluiceInjectShim told;
    char path[4096];
    Dl_info here;
    if (dladdr((const void*)&tried, &here) == 0 || here.dli_fname == NULL) {
        return NULL;
    }
    const char* slash = strrchr(here.dli_fname, '/');
    const int folder = slash == NULL ? 0 : (int)(slash - here.dli_fname) + 1;
    const int length = snprintf(path, sizeof(path), "%.*s%s", folder, here.dli_fname, SLUICE_INJECT_PAYLOAD_FILE);
    if (length < 0 || (size_t)length >= sizeof(path)) {
        return NULL;
    }
    void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        (void)fprintf(stderr, "sluice inject: no fluid in this process: %s\n", dlerror());
        return NULL;
    }
    const SluiceInjectEntry entry = (SluiceInjectEntry)as_function(real_dlsym()(library, SLUICE_INJECT_ENTRY_SYMBOL));
    told = shim;
    told.settings = shim_settings();
    const SluiceInjectPayload* loaded = entry == NULL ? NULL : entry(&told);
    if (entry == NULL || (loaded != NULL && loaded->size != sizeof(SluiceInjectPayload))) {
        (void)fprintf(stderr, "sluice inject: no fluid in this process: %s is not of this installation\n", path);
        return NULL;
    }
    return loaded;
}

const SluiceInjectPayload* shim_enter_loading(void) {
    if (inside) {
        return NULL;
    }
    if (__atomic_exchange_n(&tried, 1, __ATOMIC_ACQ_REL) == 0) {
        inside = 1; /* what the payload's libraries look up while they are loaded is none of the program's doing */
        __atomic_store_n(&payload, load(), __ATOMIC_RELEASE);
        inside = 0;
    }
    return shim_enter();
}
