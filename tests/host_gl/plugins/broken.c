/* SPDX-License-Identifier: MIT
 * Renderers that are broken in one way each, chosen by SLUICE_BREAK_* when compiled. They stop before any image is
 * shared, so none needs a device. */
#include <stddef.h>
#include <string.h>

#include "sluice/plugin.h"

#define EXPORT __attribute__((visibility("default")))

#if defined(SLUICE_BREAK_SYMBOL)
EXPORT int sluice_not_a_renderer(void) {
    return 0;
}
#elif defined(SLUICE_BREAK_TABLE)
EXPORT const SluiceRendererApi* sluice_renderer_entry(uint32_t abi_version) {
    (void)abi_version;
    return NULL;
}
#else
static SluiceResult describe(const SluiceHostServices* host, const SluiceCreateInfo* info,
                             SluiceRendererCapabilities* capabilities, SluiceError* error) {
    (void)host, (void)info, (void)capabilities, (void)error;
    return SLUICE_ERROR_UNSUPPORTED;
}

static SluiceResult explain(const SluiceSceneNeeds* needs, SluiceLineSink sink, void* user, SluiceError* error) {
    (void)needs, (void)sink, (void)user, (void)error;
    return SLUICE_ERROR_UNSUPPORTED;
}

static SluiceResult create(const SluiceHostServices* host, const SluiceCreateInfo* info, SluiceRenderer** renderer,
                           SluiceError* error) {
    (void)host, (void)info;
#if defined(SLUICE_BREAK_CREATE_GARBAGE)
    /* No terminator, control characters, an unheard-of code and a renderer that is none. */
    memset(error->message, '\x01', sizeof(error->message));
    memcpy(error->message, "garbage", 7);
    *renderer = NULL;
    return (SluiceResult)-12345;
#elif defined(SLUICE_BREAK_CREATE_SILENT)
    (void)error;
    *renderer = NULL;
    return SLUICE_ERROR_UNSUPPORTED;
#elif defined(SLUICE_BREAK_CREATE_POSITIVE)
    (void)error;
    *renderer = NULL;
    return SLUICE_NOT_READY;
#elif defined(SLUICE_BREAK_NO_IMAGES) || defined(SLUICE_BREAK_SHORT_INFO)
    (void)error;
    *renderer = (SluiceRenderer*)(void*)renderer; /* never followed */
    return SLUICE_OK;
#else
    (void)error;
    *renderer = NULL;
    return SLUICE_OK;
#endif
}

static SluiceResult info(SluiceRenderer* renderer, SluiceRendererInfo* out) {
    (void)renderer;
    /* Says that it made what the tests ask for. */
    out->timeline = SLUICE_TIMELINE_FINISH;
    out->image_sets = 2;
    out->width = 32;
    out->height = 16;
    out->formats[SLUICE_IMAGE_HOST_DEPTH] = SLUICE_FORMAT_D32F;
#ifdef SLUICE_BREAK_SHORT_INFO
    out->struct_size = 12;
#endif
    return SLUICE_OK;
}

static SluiceResult resize(SluiceRenderer* renderer, uint32_t width, uint32_t height, SluiceError* error) {
    (void)renderer, (void)width, (void)height, (void)error;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult set_particles(SluiceRenderer* renderer, const SluiceParticles* particles, SluiceError* error) {
    (void)renderer, (void)particles, (void)error;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult set_environment(SluiceRenderer* renderer, const SluiceEnvironment* environment,
                                    SluiceError* error) {
    (void)renderer, (void)environment, (void)error;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult submit_frame(SluiceRenderer* renderer, const SluiceFrame* frame, SluiceError* error) {
    (void)renderer, (void)frame, (void)error;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult poll(SluiceRenderer* renderer, uint64_t frame, SluiceFrameStats* stats) {
    (void)renderer, (void)frame, (void)stats;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult timeline_signal(SluiceRenderer* renderer, uint64_t value) {
    (void)renderer, (void)value;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult timeline_wait(SluiceRenderer* renderer, uint64_t value, uint64_t timeout_ns) {
    (void)renderer, (void)value, (void)timeout_ns;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult timeline_value(SluiceRenderer* renderer, uint32_t direction, uint64_t* value) {
    (void)renderer, (void)direction, (void)value;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult timeline_export(SluiceRenderer* renderer, uint32_t direction, uint64_t value, int32_t* fd,
                                    SluiceError* error) {
    (void)renderer, (void)direction, (void)value, (void)fd, (void)error;
    return SLUICE_ERROR_INTERNAL;
}

static SluiceResult probe_format(const SluiceHostServices* host, const SluiceCreateInfo* create_info, uint32_t format,
                                 uint32_t width, uint32_t height, SluiceError* error) {
    (void)host, (void)create_info, (void)format, (void)width, (void)height, (void)error;
    return SLUICE_ERROR_INTERNAL;
}

static void destroy(SluiceRenderer* renderer) {
    (void)renderer;
}

static SluiceRendererApi api;

EXPORT const SluiceRendererApi* sluice_renderer_entry(uint32_t abi_version) {
    (void)abi_version;
    const SluiceRendererApi table = {sizeof(SluiceRendererApi),
                                     SLUICE_ABI_VERSION,
                                     "broken",
                                     "0",
                                     describe,
                                     explain,
                                     create,
                                     info,
                                     resize,
                                     set_particles,
                                     set_environment,
                                     submit_frame,
                                     poll,
                                     timeline_signal,
                                     timeline_wait,
                                     timeline_value,
                                     timeline_export,
                                     probe_format,
                                     destroy,
                                     NULL,
                                     NULL,
                                     NULL,
                                     NULL,
                                     NULL,
                                     NULL,
                                     NULL,
                                     NULL};
    api = table;
#ifdef SLUICE_BREAK_ABI_MAJOR
    api.abi_version = SLUICE_MAKE_ABI(SLUICE_ABI_MAJOR + 1u, 0u);
#endif
#ifdef SLUICE_BREAK_SHORT_TABLE
    api.struct_size = (uint32_t)offsetof(SluiceRendererApi, poll);
#endif
#ifdef SLUICE_BREAK_NULL_FUNCTION
    api.submit_frame = NULL;
#endif
    return &api;
}
#endif
