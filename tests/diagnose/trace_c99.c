/* SPDX-License-Identifier: MIT
 * sluice_trace.h as a C99 engine meets it: writes one log of every function, and calls every function with nothing. */
#include "sluice/sluice_trace.h"

int sluice_c99_write_log(const char* path, int leave_out_the_wait);
int sluice_c99_call_all_with(SluiceTraceLog* log, uint32_t none);
size_t sluice_c99_memory_size(void);

size_t sluice_c99_memory_size(void) {
    return sizeof(SluiceTraceMemory);
}

int sluice_c99_write_log(const char* path, int leave_out_the_wait) {
    char why[128] = "";
    SluiceTraceMemory facts = {{1}, {2}, 4096, 0, 1};
    SluiceTraceLog* log = sluice_trace_open(path, why, sizeof why);
    const uint32_t thread = sluice_trace_actor(log, SLUICE_TRACE_HOST_THREAD, "thread");
    const uint32_t gl = sluice_trace_actor(log, SLUICE_TRACE_GL_CONTEXT, "gl");
    const uint32_t queue = sluice_trace_actor(log, SLUICE_TRACE_VULKAN_QUEUE, "queue");
    const uint32_t ready = sluice_trace_sync(log, SLUICE_TRACE_TIMELINE, "ready", 0, 0);
    const uint32_t fence = sluice_trace_sync(log, SLUICE_TRACE_FENCE, "fence", 0, 0);
    const uint32_t image = sluice_trace_resource(log, "image", 1, SLUICE_TRACE_NONE);
    uint64_t frame;
    sluice_trace_export(log, queue, image, &facts);
    sluice_trace_fd_open(log, thread, 7);
    sluice_trace_fd_give(log, thread, 7);
    sluice_trace_import(log, gl, image, &facts);
    for (frame = 1; frame <= 3; ++frame) {
        uint64_t began;
        sluice_trace_frame(log, thread, frame);
        sluice_trace_renew_sync(log, fence, SLUICE_TRACE_FENCE, "fence", 0, 0);
        sluice_trace_submit(log, thread, gl, frame);
        sluice_trace_write(log, gl, image, frame);
        sluice_trace_signal(log, gl, ready, frame);
        sluice_trace_submit(log, thread, queue, frame);
        if (!leave_out_the_wait) {
            sluice_trace_wait(log, queue, ready, frame);
        }
        sluice_trace_read(log, queue, image, frame);
        sluice_trace_signal(log, queue, fence, 0);
        began = sluice_trace_wait_begin(log, thread, fence, 0);
        sluice_trace_wait_end(log, thread, fence, 0, began, 0);
        sluice_trace_flush(log);
    }
    sluice_trace_destroy_sync(log, thread, ready);
    sluice_trace_destroy_resource(log, thread, image);
    sluice_trace_actor_end(log, gl);
    sluice_trace_actor_end(log, queue);
    return sluice_trace_status(log, NULL, 0) == 0 ? sluice_trace_close(log) : -1;
}

int sluice_c99_call_all_with(SluiceTraceLog* log, uint32_t none) {
    const SluiceTraceMemory facts = {{0}, {0}, 1, 0, 0};
    int wrong = 0;
    sluice_trace_flush(log);
    wrong += sluice_trace_actor(log, 77, NULL) != SLUICE_TRACE_NONE;
    wrong += sluice_trace_sync(log, 77, NULL, 0, 0) != SLUICE_TRACE_NONE;
    wrong += log == NULL && sluice_trace_actor(log, SLUICE_TRACE_PROCESS, "p") != SLUICE_TRACE_NONE;
    wrong += log == NULL && sluice_trace_sync(log, SLUICE_TRACE_BINARY, "b", 0, 0) != SLUICE_TRACE_NONE;
    wrong += log == NULL && sluice_trace_resource(log, "r", 0, none) != SLUICE_TRACE_NONE;
    sluice_trace_renew_sync(log, none, SLUICE_TRACE_FENCE, NULL, 0, 0);
    sluice_trace_signal(log, none, none, 1);
    sluice_trace_wait(log, none, none, 1);
    sluice_trace_wait_end(log, none, none, 1, sluice_trace_wait_begin(log, none, none, 1), 1);
    sluice_trace_submit(log, none, none, 1);
    sluice_trace_read(log, none, none, 1);
    sluice_trace_write(log, none, none, 1);
    sluice_trace_release(log, none, none, none, 0, 1);
    sluice_trace_acquire(log, none, none, none, 0, 1);
    sluice_trace_layout(log, none, none, 0, 1);
    sluice_trace_names(log, none, none, 0);
    sluice_trace_witness(log, none, none, 1, SLUICE_TRACE_TORN);
    sluice_trace_export(log, none, none, &facts);
    sluice_trace_import(log, none, none, NULL);
    sluice_trace_destroy_sync(log, none, none);
    sluice_trace_destroy_resource(log, none, none);
    sluice_trace_fd_open(log, none, -1);
    sluice_trace_fd_give(log, none, -1);
    sluice_trace_fd_close(log, none, -1);
    sluice_trace_frame(log, none, 1);
    sluice_trace_actor_end(log, none);
    wrong += log == NULL && sluice_trace_status(log, NULL, 0) != -1;
    wrong += log == NULL && sluice_trace_close(log) != -1;
    return wrong;
}
