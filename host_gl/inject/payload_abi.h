/* SPDX-License-Identifier: MIT
 *
 * payload_abi.h - what the preloaded shim and the payload that it loads tell each other.
 *
 * Both come from one build and lie side by side; `size` only catches an installation that mixes two. The shim holds a
 * guard on the calling thread around every call into the payload: OpenGL calls made inside it go straight to the
 * driver.
 */
#ifndef SLUICE_INJECT_PAYLOAD_ABI_H
#define SLUICE_INJECT_PAYLOAD_ABI_H

/* C99: what clang-tidy would modernise in C++ has to stay as it is. NOLINTBEGIN(modernize-*) */
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SLUICE_INJECT_ENTRY_SYMBOL "sluice_inject_entry"
#define SLUICE_INJECT_PAYLOAD_FILE "libsluice_payload.so"

enum { SLUICE_INJECT_GLX = 0, SLUICE_INJECT_EGL = 1, SLUICE_INJECT_ANY = 2 /* whichever is current */ };
enum { SLUICE_INJECT_VIA_SYMBOL = 1, SLUICE_INJECT_VIA_GET_PROC_ADDRESS = 2, SLUICE_INJECT_VIA_DLSYM = 4 };

typedef void (*SluiceInjectFunction)(void); /* any function; cast it before the call */

/* One hooked function: how often it was called, and by which ways its address was given to the program. */
typedef struct SluiceInjectHook {
    const char* name;
    SluiceInjectFunction real; /* NULL until it was first needed */
    uint64_t calls;
    uint32_t via; /* SLUICE_INJECT_VIA_*; a call without any is one through a plain symbol */
} SluiceInjectHook;

typedef struct SluiceInjectShim {
    uint32_t size;
    const char* settings; /* lines "key value"; lives as long as the process */
    SluiceInjectFunction (*real)(
        const char* name); /* a function of GL, GLX or EGL past all hooks; NULL if there is none */
    const SluiceInjectHook* hooks;
    uint32_t hook_count;
} SluiceInjectShim;

/* Called on the thread that called the hooked function, before the real one unless said otherwise. */
typedef struct SluiceInjectPayload {
    uint32_t size;
    /* The frame is complete, and a context is current. `route` is the hooked function's name. */
    void (*swap)(uint32_t api, void* display, uintptr_t drawable, const char* route);
    void (*made_current)(void); /* after: another context is current on this thread, or none */
    void (*destroy_context)(uint32_t api, void* display, void* context); /* current or not */
    void (*matrix_mode)(uint32_t mode);
    void (*matrix_changed)(void); /* after: the current matrix has another value, or may have */
    void (*matrix_pushed)(void);
    void (*matrix_popped)(void);
    void (*use_program)(uint32_t program);
    void (*uniform_matrix)(uint32_t program, int32_t location, int32_t count, uint32_t transpose, const float* value);
    void (*bind_framebuffer)(uint32_t target, uint32_t framebuffer);
    void (*list_mode)(uint32_t mode); /* glNewList's, 0 at glEndList */
    void (*draw)(uint32_t vertices);  /* outside glBegin and glEnd; 0: nobody knows how many */
    void (*clear)(uint32_t mask);
    void (*blocks_changed)(void);        /* after: what the uniform blocks of a program hold may be something else */
    void (*take_error)(uint32_t* error); /* sets it if the payload took an error of the program's own from the driver */
    void (*attributes_popped)(void);     /* after: the matrix mode may be another */
    void (*list_called)(void);           /* after, likewise */
    void (*program_linked)(uint32_t program);                           /* after */
    void (*program_deleted)(uint32_t program);                          /* after */
    void (*framebuffers_deleted)(int32_t count, const uint32_t* names); /* after: one that was bound is not any more */
    void (*context_created)(uint32_t api, void* context);               /* after; its address may be known already */
    void (*display_ended)(void* display);                               /* of EGL, with its contexts */
    void (*viewport_changed)(void);                                     /* after */
    void (*clear_of)(uint32_t framebuffer, uint32_t mask);              /* of a framebuffer, bound or not */
} SluiceInjectPayload;

/* NULL: nothing is to be done in this process, and a line on stderr has said why. */
typedef const SluiceInjectPayload* (*SluiceInjectEntry)(const SluiceInjectShim* shim);

#ifdef __cplusplus
}
#endif

/* NOLINTEND(modernize-*) */
#endif
