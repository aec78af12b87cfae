/* SPDX-License-Identifier: MIT
 *
 * sluice/sluice.h - fluid in an OpenGL engine that was never built for it, in five calls.
 *
 *     Sluice* fluid = NULL;
 *     sluice_create(&options, &fluid);                     once, with the engine's GL context current
 *     sluice_resize(fluid, width, height);                 when the drawable's size changes
 *     sluice_begin_frame(fluid, view, projection, time);   before the engine draws; the fluid flows meanwhile
 *     sluice_end_frame(fluid);                             after the world, before the HUD
 *     sluice_destroy(fluid);
 *
 * C99. libsluice.so is found with pkg-config sluice, find_package(Sluice) or dlopen("libsluice.so.1"); it links neither
 * the engine nor a window system, and exports nothing but what is declared here. docs/retrofit.md is the guide.
 *
 * CONTEXTS
 *   Desktop OpenGL, compatibility or core, whichever version the engine asked for, made by EGL or GLX (so also by SDL,
 *   GLUT, GLFW ...). The driver must report 2.1 or newer, framebuffer objects and GL_EXT_memory_object_fd; today's
 *   drivers do so to engines that ask for 1.x too. A Sluice belongs to the context that was current when it was made.
 *   One context may have several. When another context is current, or the old one has been destroyed, the next
 *   sluice_begin_frame makes everything anew in the present one, and the fluid begins again.
 *
 * STATE
 *   Every call leaves the GL state as it found it, error flags included, and needs no free level of any stack. Not
 *   between glBegin and glEnd, nor while a display list is compiled, nor in selection or feedback mode (the latter
 * three are refused). Fragments of the composite count in an occlusion query that is active, and are subject to
 * conditional rendering: end both before.
 *
 * THE FRAMEBUFFER
 *   sluice_end_frame takes depth and colour of the framebuffer that is bound for drawing and draws into its draw buffer
 *   0: a window, with or without samples, or a framebuffer object of one 2-D layer with colour and depth, with or
 *   without samples. Nearer is smaller in its depth: reversed depth is refused. A glDepthRange that is there at both
 *   sluice_begin_frame and sluice_end_frame is the world's; else 0 to 1 is. Colours as a monitor takes them: what is in
 *   an RGBA8 buffer or, encoded, in an sRGB one. Scissor and GL_FRAMEBUFFER_SRGB do not matter, nor does the viewport
 *   but for one that covers more than the size that was told.
 *
 * FAILURE
 *   Nothing aborts, throws or writes to stdout. A call that fails leaves the engine's frame as it was and returns a
 *   negative SluiceResult; sluice_last_error has the text; the log hears of each failure once, however often it comes
 *   back. Every function takes a NULL Sluice and returns SLUICE_ERROR_INVALID_ARGUMENT, so that an engine need not look
 *   at the results at all. The renderer runs in a process of its own unless asked otherwise: if it crashes or hangs,
 *   the engine goes on without fluid and gets another one a few frames later. It is no child of the engine's process
 *   and ends with it. A renderer that hangs while it starts can hold sluice_begin_frame or sluice_end_frame for as long
 *   as SluiceOptions::start_deadline says, two minutes if nothing else is asked for.
 *
 * OWNERSHIP, THREADS
 *   What is passed in is copied during the call. Everything on the thread on which the context is current. The log
 *   callback may come on any thread and must not call back.
 *
 * UNITS
 *   As in sluice/plugin.h: metres, seconds, right-handed world, matrices in the column order of glLoadMatrixf. An
 *   engine of U units to the metre gives what is of the fluid in metres, its projection as it is, and its view times a
 *   scale by U on the right, as by glScalef(U, U, U); or it divides the view's translation, near and far by U.
 *
 * GROWTH
 *   As in sluice/plugin.h: structs by pointer begin with struct_size, which sluice_*_defaults sets and which may be set
 *   by hand; fields are appended only, and a missing one has its default. libsluice.so.1 serves every 1.x program.
 */
#ifndef SLUICE_SLUICE_H
#define SLUICE_SLUICE_H

/* NOLINTBEGIN(modernize-*,performance-enum-size,bugprone-macro-parentheses) */
#include <stddef.h>
#include <stdint.h>

#include "sluice/plugin.h"

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SLUICE_EXPORT __attribute__((visibility("default")))
#else
#define SLUICE_EXPORT
#endif

#define SLUICE_API_MAJOR 1u
#define SLUICE_API_MINOR 0u
#define SLUICE_API_VERSION SLUICE_MAKE_ABI(SLUICE_API_MAJOR, SLUICE_API_MINOR)

typedef struct Sluice Sluice;

/* Of the library that runs; its upper 16 bits must be SLUICE_API_MAJOR. */
SLUICE_EXPORT uint32_t sluice_api_version(void);

enum SluiceProcess {
    SLUICE_PROCESS_OWN = 0, /* the renderer in a process of its own */
    SLUICE_PROCESS_SAME = 1 /* in the engine's: a little faster, and a crash in a Vulkan driver is the engine's */
};

typedef struct SluiceOptions {
    uint32_t struct_size;
    uint32_t api_version;   /* SLUICE_API_VERSION */
    uint32_t width, height; /* pixels of the drawable, not of the viewport. Both 0: the drawable or the framebuffer
                               object is asked in every frame, and no sluice_resize is needed */
    uint32_t process;       /* SluiceProcess */
    uint32_t timeline;      /* SluiceTimelineKind; AUTO is right */
    const char* plugin;     /* NULL: $SLUICE_PLUGIN, else beside libsluice.so or in sluice/ there */
    const char* renderer_program; /* NULL: sluice-renderer beside libsluice.so or in ../bin */
    double frame_deadline;        /* seconds that a call into another process may take in a frame before it is ended */
    void (*log)(void* user, int32_t level, const char* message); /* NULL: warnings and errors as a line on stderr */
    void* log_user;
    const char*
        ledger_log;   /* NULL: $SLUICE_LEDGER_LOG, else none: a file for `sluice diagnose`, of the first context */
    uint32_t timings; /* 1: find out where the time of a frame goes, for SluiceStatistics */
    /* 1: sluice_create does not wait for the renderer's process. Until it is there, frames return SLUICE_NOT_READY,
     * which is no error, and are the engine's own. Without a process of its own this means nothing. */
    uint32_t start_in_background;
    double start_deadline; /* seconds that any one call of a start may take before the process is ended */
} SluiceOptions;
/* struct_size is the caller's sizeof; it is set, and nothing beyond it is written. */
SLUICE_EXPORT void sluice_options_defaults(SluiceOptions* options, size_t struct_size);

/* With the context current. On failure *fluid is NULL, and sluice_last_error(NULL) says why. There is no fluid until
 * sluice_set_water; frames then cost nothing. */
SLUICE_EXPORT SluiceResult sluice_create(const SluiceOptions* options, Sluice** fluid);

/* The drawable's size in pixels. Waits for the frame before. */
SLUICE_EXPORT SluiceResult sluice_resize(Sluice* fluid, uint32_t width, uint32_t height);

/* The frame begins: the fluid flows until `time` (seconds of any clock; at most a tenth of a second is made good, and
 * time that goes back counts as none) while the engine draws. view is world to eye, projection eye to clip,
 * perspective; both NULL: GL_MODELVIEW_MATRIX and GL_PROJECTION_MATRIX as they are now, where the context has them. */
SLUICE_EXPORT SluiceResult sluice_begin_frame(Sluice* fluid, const float* view, const float* projection, double time);

/* Another camera for the frame that has begun, for engines that know it late. */
SLUICE_EXPORT SluiceResult sluice_set_camera(Sluice* fluid, const float* view, const float* projection);

/* The world has been drawn: depth and colour of the framebuffer bound for drawing are taken, and the fluid is drawn
 * into it with its own depth, which it writes. Once for each sluice_begin_frame; a frame that could not begin ends with
 * the reason that it had, and one that began without this water, or switched off, with SLUICE_NOT_READY. */
SLUICE_EXPORT SluiceResult sluice_end_frame(Sluice* fluid);

/* With the context current if it still exists; without, or with another one, nothing is asked of OpenGL. NULL is
 * ignored. */
SLUICE_EXPORT void sluice_destroy(Sluice* fluid);

/* ---------------------------------------------------------------------------------------------------- the fluid -- */

/* A box of fluid at the start. Stands in an array, so its size is for good. */
typedef struct SluiceBlock {
    float low[3], high[3];
    float velocity[3];    /* metres per second */
    uint32_t fluid;       /* its place in SluiceWater::fluids */
    uint32_t reserved[6]; /* zero */
} SluiceBlock;

/* Where fluid is and what it does. docs/simulation.md has the solver's numbers. */
typedef struct SluiceWater {
    uint32_t struct_size;
    float radius;          /* of a particle; the detail, and by its third power the cost. 0.05 */
    float low[3], high[3]; /* the box that nothing leaves; its lower side is a floor */
    float gravity[3];      /* 0, -9.81, 0 */
    uint32_t block_count;
    const SluiceBlock* blocks;
    uint32_t solid_count;
    const SluiceSolid* solids; /* that the fluid stays out of */
    uint32_t iterations;       /* of the solver, a step; 4 */
    uint32_t steps_per_second; /* at least; fast fluid takes more. 240 */
    float viscosity;           /* 0.02 */
    float vorticity;           /* 0 */
    float tension, adhesion;   /* m/s^2; 0 */
    uint32_t max_particles;    /* at which emitters stop; 0: 100,000 more than the blocks hold, without emitters none */
    uint32_t emitter_count, drain_count, field_count, body_count;
    const SluiceEmitter* emitters; /* nozzles, from whose opening fluid comes */
    const SluiceDrain* drains;     /* and where it goes */
    const SluiceForceField* fields;
    const SluiceBody* bodies; /* that float, or go where the engine says: sluice_set_body */
    uint32_t path_point_count, mesh_count, mesh_corner_count, mesh_triangle_count;
    const SluicePathPoint* path_points; /* these four as in SluiceSimulation */
    const SluiceMesh* meshes;
    const float* mesh_corners;
    const uint32_t* mesh_indices;
    /* The fluid collides with what the engine's depth shows, a frame late: pixels each way that become one, 1..8, of
     * which 4 is a good start; 0: it does not. Needs a view that turns and moves and does not scale. */
    uint32_t depth_scale;
    float depth_thickness;         /* metres that what is seen is deep for who comes round its edge; 0: a radius */
    const SluiceFluidKind* fluids; /* several, such as oil and water, of which blocks and emitters name one each; none:
                                      one of density 1, with the viscosity, tension and adhesion above */
    uint32_t fluid_count;          /* at most SLUICE_MAX_FLUIDS */
    uint32_t reserved;             /* zero */
} SluiceWater;
SLUICE_EXPORT void sluice_water_defaults(SluiceWater* water, size_t struct_size);

/* Let this fluid begin; NULL: no fluid. */
SLUICE_EXPORT SluiceResult sluice_set_water(Sluice* fluid, const SluiceWater* water);

/* What may change while it flows: from the next frame on, the fluid that there is stays. Emitters may be moved, opened
 * and shut: as many as in SluiceWater, or fewer. sluice_flow_of is what a water begins with, so change that. */
SLUICE_EXPORT void sluice_flow_of(const SluiceWater* water, SluiceFlow* flow, size_t struct_size);
SLUICE_EXPORT SluiceResult sluice_set_flow(Sluice* fluid, const SluiceFlow* flow);

/* Where a driven body is to be at the end of the frame that begins next. */
SLUICE_EXPORT SluiceResult sluice_set_body(Sluice* fluid, uint32_t body, const SluiceBodyTarget* target);
/* Where all bodies are, as far as has been simulated: what the engine draws them at. SLUICE_NOT_READY at the start. */
SLUICE_EXPORT SluiceResult sluice_bodies(Sluice* fluid, SluiceBodies* bodies);

/* How it looks. */
SLUICE_EXPORT void sluice_look_defaults(SluiceFluid* look);
SLUICE_EXPORT SluiceResult sluice_set_look(Sluice* fluid, const SluiceFluid* look);
/* Of several fluids: how those after the first look, in the order of SluiceWater::fluids; those beyond the count, at
 * most SLUICE_MAX_FLUIDS - 1, look like the first. */
SLUICE_EXPORT SluiceResult sluice_set_other_looks(Sluice* fluid, const SluiceLook* looks, uint32_t count);
/* What it mirrors and what lights it: a sky, or a latitude-longitude map (NULL: the sky again). */
SLUICE_EXPORT void sluice_sky_defaults(SluiceSky* sky);
SLUICE_EXPORT SluiceResult sluice_set_sky(Sluice* fluid, const SluiceSky* sky);
SLUICE_EXPORT SluiceResult sluice_set_environment(Sluice* fluid, const SluiceEnvironment* environment);

/* 0: frames pass as if there were no fluid, and what there is stands still. 1, at first: it is drawn. */
SLUICE_EXPORT SluiceResult sluice_set_enabled(Sluice* fluid, uint32_t enabled);

/* ------------------------------------------------------------------------------------------------ what happened -- */

/* Of the last call that failed: what, the value, the remedy. Never NULL; "" if none failed. Valid until the next call
 * for the same Sluice; of NULL, the last sluice_create of this thread that failed. */
SLUICE_EXPORT const char* sluice_last_error(const Sluice* fluid);

typedef struct SluiceStatistics {
    uint32_t struct_size;
    uint32_t width, height;  /* of the shared images */
    uint32_t timeline;       /* SluiceTimelineKind in use; 0 while there is no renderer */
    uint64_t frames;         /* sluice_end_frame that drew fluid */
    uint64_t frames_without; /* that should have and did not */
    uint32_t renderers;      /* created so far in this context: more than 1 when one has been lost */
    uint32_t contexts;       /* GL contexts that this Sluice has lived in */
    uint32_t particles;
    uint32_t reserved;
    uint64_t steps;             /* of the simulation */
    uint64_t simulation_failed; /* 0, or the frame from which the fluid stands still because a step failed */
    double
        end_frame_seconds; /* of the calling thread in the last sluice_end_frame: capture, hand-over, wait, composite */
    char device[128];      /* that renders */
    /* With SluiceOptions::timings, sums over all frames, else 0. The first and the last are GL's own time and come some
     * frames late; fluid and simulation are the renderer's queue's, and run beside the engine. */
    double capture_seconds, hand_over_seconds, fluid_seconds, simulation_seconds, composite_seconds;
    double wait_seconds;            /* of end_frame_seconds: the wait for the renderer, and the composite */
    double last_simulation_seconds; /* that the fluid's last frame took, beside the engine's own work */
    uint64_t cpu_copy_bytes;        /* of shared images in the last frame that drew fluid; 0 by contract */
    uint64_t upload_bytes;          /* of particles, likewise; 0 while the fluid flows in the renderer */
    uint32_t pass_count, reserved_2;
    SluicePassStats passes[SLUICE_MAX_PASSES]; /* of that frame: which ran, and how long */
} SluiceStatistics;
SLUICE_EXPORT SluiceResult sluice_statistics(Sluice* fluid, SluiceStatistics* statistics);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-*,performance-enum-size,bugprone-macro-parentheses) */
#endif
