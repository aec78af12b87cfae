/* SPDX-License-Identifier: MIT
 *
 * Log your own OpenGL and Vulkan fences, then let `sluice diagnose LOG` say which order is missing. C99, no OpenGL, no
 * Vulkan, no other header of Sluice: link libsluice_trace (shared, or the static one with -lstdc++ -lpthread).
 *
 * What to log: every call that orders or touches shared memory, beside the call itself. An actor is whoever runs things
 * in one order of its own: a GL context (its command stream), a Vulkan queue, a thread. A thread that records commands
 * for a queue is another actor than the queue; sluice_trace_submit joins the two.
 *
 *     OpenGL / Vulkan                                     here
 *     glFenceSync(...)                                    sluice_trace_signal(log, gl, fence, 0)
 *     glClientWaitSync, vkWaitForFences, vkWaitSemaphores sluice_trace_wait_begin ... sluice_trace_wait_end (a thread)
 *     glWaitSync, glWaitSemaphoreEXT, pWaitSemaphores     sluice_trace_wait(log, stream, sync, value)
 *     glSignalSemaphoreEXT, pSignalSemaphores, vkSignalSemaphore
 *                                                         sluice_trace_signal(log, stream or thread, sync, value)
 *     vkQueueSubmit                                       sluice_trace_submit(log, thread, queue, number), and then the
 *                                                         queue's waits, accesses and signals of that submission
 *     a draw or dispatch that reads or writes a shared image or buffer
 *                                                         sluice_trace_read / sluice_trace_write
 *
 * Threads: every function may be called from any thread at any time between open and close. The events of one actor
 * must be logged in that actor's own order; between actors any order will do.
 * Ownership: the log belongs to the caller until sluice_trace_close. Strings and structs are copied before the call
 * returns. After fork() only one of the two processes may go on with a log.
 * Errors: no function aborts, throws or blocks on anything but its lock and a write of 64 KiB now and then. A NULL log
 * and the id SLUICE_TRACE_NONE make any call do nothing, so an engine need not check what open or a declaration
 * returned. When a write fails (disk full), later records are dropped and counted, and sluice_trace_status says so.
 * Cost: a mutex and a copy of 48 bytes per event.
 *
 * This file is C; the C++ modernisers have nothing to say about it.
 * NOLINTBEGIN(modernize-*,performance-enum-size,bugprone-macro-parentheses) */
#ifndef SLUICE_TRACE_H
#define SLUICE_TRACE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define SLUICE_TRACE_API __attribute__((visibility("default")))
#else
#define SLUICE_TRACE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* An id that stands for nothing: "external" where an owner is asked for, and what a declaration returns that failed. */
#define SLUICE_TRACE_NONE 0xFFFFFFFFu

typedef struct SluiceTraceLog SluiceTraceLog;

typedef enum SluiceTraceActorKind {
    SLUICE_TRACE_GL_CONTEXT,
    SLUICE_TRACE_VULKAN_QUEUE,
    SLUICE_TRACE_HOST_THREAD,
    SLUICE_TRACE_BRIDGE_THREAD, /* a thread that carries signals from one API to the other */
    SLUICE_TRACE_PROCESS
} SluiceTraceActorKind;

typedef enum SluiceTraceSyncKind {
    SLUICE_TRACE_TIMELINE, /* a 64-bit counter; a wait for v is satisfied by any signal of at least v */
    SLUICE_TRACE_BINARY,   /* each signal serves one wait; values are ignored, pass 0 */
    SLUICE_TRACE_FENCE /* GLsync, VkFence: signalled once, waited for any number of times; values are ignored. A VkFence
                          that was reset, or a new GLsync, is declared anew */
} SluiceTraceSyncKind;

/* Flag of sluice_trace_sync: makes only those resources visible that sluice_trace_names lists before the signal and
 * before the wait (GL_EXT_semaphore). */
#define SLUICE_TRACE_LISTED_ONLY 1u

typedef enum SluiceTraceVerdict {
    SLUICE_TRACE_FRESH, /* the contents were those expected */
    SLUICE_TRACE_STALE, /* those of an older version */
    SLUICE_TRACE_TORN   /* parts of several versions */
} SluiceTraceVerdict;

/* How memory was made or imported. */
typedef struct SluiceTraceMemory {
    uint8_t device_uuid[16], driver_uuid[16];
    uint64_t size;      /* bytes of the allocation */
    uint32_t tiling;    /* 0 optimal, 1 linear */
    uint32_t dedicated; /* 1: the memory belongs to this one image */
} SluiceTraceMemory;

/* ---- The log ----------------------------------------------------------------------------------------------------- */

/* Creates or replaces the file. NULL when that fails; why[0..why_size) then has one sentence (why may be NULL). */
SLUICE_TRACE_API SluiceTraceLog* sluice_trace_open(const char* path, char* why, size_t why_size);
/* Writes what is buffered and the mark of a log that was ended on purpose, and frees `log`. 0 when every record reached
 * the file, else -1. A log that is never closed (a crash) is readable up to the last flush or 64 KiB. */
SLUICE_TRACE_API int sluice_trace_close(SluiceTraceLog* log);
/* Writes what is buffered: once a frame is a good place. */
SLUICE_TRACE_API void sluice_trace_flush(SluiceTraceLog* log);
/* 0 while every record was taken, else -1 and one sentence in `why` (may be NULL). NULL log: -1. */
SLUICE_TRACE_API int sluice_trace_status(const SluiceTraceLog* log, char* why, size_t why_size);
/* CLOCK_MONOTONIC in nanoseconds, the clock of every time in a log. */
SLUICE_TRACE_API uint64_t sluice_trace_now(void);

/* ---- Who and what ------------------------------------------------------------------------------------------------ */

/* Each returns the id of a new object, SLUICE_TRACE_NONE on failure. Names are for people; NULL is "". At most 1,024
 * actors. Layouts are VkImageLayout numbers (VK_IMAGE_LAYOUT_GENERAL is 1). kind: SluiceTraceActorKind or
 * SluiceTraceSyncKind, as a plain integer so that an unknown value is refused and not undefined; verdict below too. */
SLUICE_TRACE_API uint32_t sluice_trace_actor(SluiceTraceLog* log, uint32_t kind, const char* name);
SLUICE_TRACE_API uint32_t sluice_trace_sync(SluiceTraceLog* log, uint32_t kind, const char* name,
                                            uint64_t initial_value, uint32_t flags);
SLUICE_TRACE_API uint32_t sluice_trace_resource(SluiceTraceLog* log, const char* name, uint32_t layout, uint32_t owner);
/* A new object under the number of an old one: a fence that was reset, a semaphore that was re-created. For engines
 * that make one each frame: it keeps the ids few. */
SLUICE_TRACE_API void sluice_trace_renew_sync(SluiceTraceLog* log, uint32_t sync, uint32_t kind, const char* name,
                                              uint64_t initial_value, uint32_t flags);

/* ---- Order ------------------------------------------------------------------------------------------------------- */

SLUICE_TRACE_API void sluice_trace_signal(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value);
/* A wait that a stream carries out by itself: log it where it is recorded. */
SLUICE_TRACE_API void sluice_trace_wait(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value);
/* A wait in which a thread stands still: begin before the call, end after it with what begin returned. timed_out: 1
 * when it ended without its value. */
SLUICE_TRACE_API uint64_t sluice_trace_wait_begin(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value);
SLUICE_TRACE_API void sluice_trace_wait_end(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value,
                                            uint64_t began_ns, int timed_out);
/* `thread` gives work to `stream`; what is then logged for `stream`, until the next submit, came with it. */
SLUICE_TRACE_API void sluice_trace_submit(SluiceTraceLog* log, uint32_t thread, uint32_t stream, uint64_t number);

/* ---- Access ------------------------------------------------------------------------------------------------------ */

/* version: which contents are written, or which the reader expects (a frame's number does); 0: any. */
SLUICE_TRACE_API void sluice_trace_read(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint64_t version);
SLUICE_TRACE_API void sluice_trace_write(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint64_t version);
/* other: the owner on the far side, SLUICE_TRACE_NONE for "external" (VK_QUEUE_FAMILY_EXTERNAL). */
SLUICE_TRACE_API void sluice_trace_release(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t other,
                                           uint32_t old_layout, uint32_t new_layout);
SLUICE_TRACE_API void sluice_trace_acquire(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t other,
                                           uint32_t old_layout, uint32_t new_layout);
SLUICE_TRACE_API void sluice_trace_layout(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t old_layout,
                                          uint32_t new_layout);
/* One entry of the list that the next signal or wait of `actor` carries (SLUICE_TRACE_LISTED_ONLY). layout: 0, none. */
SLUICE_TRACE_API void sluice_trace_names(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t layout);
/* What a look at the contents showed: which version was found; verdict is a SluiceTraceVerdict. */
SLUICE_TRACE_API void sluice_trace_witness(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint64_t found,
                                           uint32_t verdict);

/* ---- Life -------------------------------------------------------------------------------------------------------- */

/* Sharing memory: the facts of both sides are compared. facts NULL: nothing is logged. */
SLUICE_TRACE_API void sluice_trace_export(SluiceTraceLog* log, uint32_t actor, uint32_t resource,
                                          const SluiceTraceMemory* facts);
SLUICE_TRACE_API void sluice_trace_import(SluiceTraceLog* log, uint32_t actor, uint32_t resource,
                                          const SluiceTraceMemory* facts);
SLUICE_TRACE_API void sluice_trace_destroy_sync(SluiceTraceLog* log, uint32_t actor, uint32_t sync);
SLUICE_TRACE_API void sluice_trace_destroy_resource(SluiceTraceLog* log, uint32_t actor, uint32_t resource);
/* Descriptors: opened; given away (a successful import takes it); closed. Negative descriptors are ignored. */
SLUICE_TRACE_API void sluice_trace_fd_open(SluiceTraceLog* log, uint32_t actor, int fd);
SLUICE_TRACE_API void sluice_trace_fd_give(SluiceTraceLog* log, uint32_t actor, int fd);
SLUICE_TRACE_API void sluice_trace_fd_close(SluiceTraceLog* log, uint32_t actor, int fd);
/* `actor` begins frame `number` (from 1); its later events belong to it. */
SLUICE_TRACE_API void sluice_trace_frame(SluiceTraceLog* log, uint32_t actor, uint64_t number);
/* `actor` will signal nothing more. */
SLUICE_TRACE_API void sluice_trace_actor_end(SluiceTraceLog* log, uint32_t actor);

#ifdef __cplusplus
}
#endif

/* NOLINTEND(modernize-*,performance-enum-size,bugprone-macro-parentheses) */
#endif /* SLUICE_TRACE_H */
