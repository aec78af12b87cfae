/* SPDX-License-Identifier: MIT
 * An engine that does not use Sluice and wants to know whether its fences hold: it draws with OpenGL, post-processes with
 * Vulkan, and logs beside each call what the call orders or touches. The calls themselves are left out here.
 *
 *   trace_your_engine LOG             the Vulkan queue reads the picture without waiting for OpenGL
 *   trace_your_engine LOG --fixed     it waits
 *
 * Then: sluice diagnose LOG --html page.html */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "sluice/sluice_trace.h"

enum { FRAMES = 8 };

typedef struct Engine {
    SluiceTraceLog* log;
    uint32_t thread, gl, queue; /* who runs things in an order of their own */
    uint32_t drawn, done;       /* timelines: OpenGL has drawn frame k; Vulkan has finished frame k */
    uint32_t picture, result;   /* shared images */
    int fixed;
} Engine;

static void work(long microseconds) {
    const struct timespec time = {0, microseconds * 1000};
    nanosleep(&time, NULL);
}

static void describe(Engine* e) {
    e->thread = sluice_trace_actor(e->log, SLUICE_TRACE_HOST_THREAD, "engine thread");
    e->gl = sluice_trace_actor(e->log, SLUICE_TRACE_GL_CONTEXT, "OpenGL");
    e->queue = sluice_trace_actor(e->log, SLUICE_TRACE_VULKAN_QUEUE, "Vulkan queue");
    e->drawn = sluice_trace_sync(e->log, SLUICE_TRACE_TIMELINE, "drawn", 0, 0);
    e->done = sluice_trace_sync(e->log, SLUICE_TRACE_TIMELINE, "done", 0, 0);
    e->picture = sluice_trace_resource(e->log, "picture", 1, SLUICE_TRACE_NONE);
    e->result = sluice_trace_resource(e->log, "result", 1, SLUICE_TRACE_NONE);
}

static void draw(Engine* e, uint64_t frame) {
    sluice_trace_frame(e->log, e->thread, frame);
    sluice_trace_frame(e->log, e->gl, frame);
    sluice_trace_submit(e->log, e->thread, e->gl, frame); /* glDraw..., glSignalSemaphoreEXT, glFlush */
    sluice_trace_write(e->log, e->gl, e->picture, frame);
    work(400);
    sluice_trace_signal(e->log, e->gl, e->drawn, frame);
}

static void postProcess(Engine* e, uint64_t frame) {
    sluice_trace_frame(e->log, e->queue, frame);
    sluice_trace_submit(e->log, e->thread, e->queue, frame); /* vkQueueSubmit */
    if (e->fixed) {
        sluice_trace_wait(e->log, e->queue, e->drawn, frame); /* pWaitSemaphores: forgotten, unless --fixed */
    }
    sluice_trace_read(e->log, e->queue, e->picture, frame);
    sluice_trace_write(e->log, e->queue, e->result, frame);
    work(600);
    sluice_trace_signal(e->log, e->queue, e->done, frame); /* pSignalSemaphores */
}

static void present(Engine* e, uint64_t frame) {
    sluice_trace_submit(e->log, e->thread, e->gl, frame);
    sluice_trace_wait(e->log, e->gl, e->done, frame); /* glWaitSemaphoreEXT */
    sluice_trace_read(e->log, e->gl, e->result, frame);
    work(100);
    sluice_trace_flush(e->log); /* a crash loses at most the frame it happens in */
}

int main(int argc, char** argv) {
    Engine e;
    char why[256];
    uint64_t frame;
    if (argc < 2 || argc > 3 || argv[1][0] == '-' || (argc == 3 && strcmp(argv[2], "--fixed") != 0)) {
        fputs("usage: trace_your_engine LOG [--fixed]\n", stderr);
        return 2;
    }
    e.fixed = argc == 3;
    e.log = sluice_trace_open(argv[1], why, sizeof why);
    if (e.log == NULL) {
        fprintf(stderr, "trace_your_engine: %s\n", why);
        return 1;
    }
    describe(&e);
    for (frame = 1; frame <= FRAMES; ++frame) {
        draw(&e, frame);
        postProcess(&e, frame);
        present(&e, frame);
    }
    return sluice_trace_close(e.log) == 0 ? 0 : 1;
}
