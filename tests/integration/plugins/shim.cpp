// SPDX-License-Identifier: MIT
// The real renderer behind a table that fails where a test asks it to. One renderer at a time.
#include "plugins/shim.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "sluice/plugin.h"

using sluice::host::test::ShimControl;

#define SLUICE_SHIM_EXPORT __attribute__((visibility("default")))

extern "C" {
SLUICE_SHIM_EXPORT extern ShimControl sluice_shim_control;
ShimControl sluice_shim_control;
}

namespace {

SluiceRendererApi table;
const SluiceRendererApi* real = nullptr;
std::uint32_t claimed = SLUICE_TIMELINE_AUTO;  // AUTO: nothing but the truth

bool has(std::uint32_t bits, std::uint32_t kind) {
    return (bits >> kind & 1U) != 0;
}

SluiceResult refuse(SluiceError* error, SluiceResult code, const char* why) {
    if (error != nullptr) {
        error->code = code;
        std::snprintf(&error->message[0], sizeof(error->message), "%s", why);
    }
    return code;
}

SluiceResult create(const SluiceHostServices* host, const SluiceCreateInfo* info, SluiceRenderer** renderer,
                    SluiceError* error) {
    ShimControl& control = sluice_shim_control;
    if (control.attempt_count < control.attempts.size()) {
        control.attempts.at(control.attempt_count) = info->timeline;
    }
    ++control.attempt_count;
    if (has(control.refuses, info->timeline)) {
        *renderer = nullptr;
        return refuse(error, SLUICE_ERROR_UNSUPPORTED, "the shim refuses this timeline");
    }
    claimed = info->timeline;
    if (claimed == SLUICE_TIMELINE_AUTO && has(control.lies, SLUICE_TIMELINE_NATIVE)) {
        claimed = SLUICE_TIMELINE_NATIVE;
    }
    SluiceCreateInfo changed = *info;
    if (has(control.lies, claimed)) {
        changed.timeline = SLUICE_TIMELINE_BRIDGED;
    } else {
        claimed = SLUICE_TIMELINE_AUTO;
    }
    static SluiceHostServices services;
    services = *host;
    if (control.mute) {
        services.trace = nullptr;
    }
    return real->create(&services, &changed, renderer, error);
}

SluiceResult info(SluiceRenderer* renderer, SluiceRendererInfo* out) {
    const SluiceResult result = real->info(renderer, out);
    if (result == SLUICE_OK && claimed != SLUICE_TIMELINE_AUTO) {
        out->timeline = claimed;
    }
    return result;
}

SluiceResult submitFrame(SluiceRenderer* renderer, const SluiceFrame* frame, SluiceError* error) {
    ++sluice_shim_control.submits;
    if (frame->frame == sluice_shim_control.lose_submit) {
        return refuse(error, SLUICE_ERROR_DEVICE_LOST, "the shim has lost its device");
    }
    if (frame->frame == sluice_shim_control.hang_frame) {
        while (!sluice_shim_control.release) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    if (frame->frame >= sluice_shim_control.fail_from && frame->frame <= sluice_shim_control.fail_to) {
        SluiceFrame changed = *frame;
        changed.outputs = UINT32_MAX;  // which the real renderer refuses
        return real->submit_frame(renderer, &changed, error);
    }
    return real->submit_frame(renderer, frame, error);
}

SluiceResult poll(SluiceRenderer* renderer, std::uint64_t frame, SluiceFrameStats* stats) {
    return frame == sluice_shim_control.lose_poll ? SLUICE_ERROR_DEVICE_LOST : real->poll(renderer, frame, stats);
}

SluiceResult timelineWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
    ++sluice_shim_control.waits;
    if (value != 0 && value == sluice_shim_control.stall_value) {
        using std::chrono::steady_clock;
        static steady_clock::time_point until;
        static std::uint64_t stalled = 0;
        if (std::exchange(stalled, value) != value) {
            until = steady_clock::now() + std::chrono::milliseconds(sluice_shim_control.stall_ms);
        }
        const auto asked = steady_clock::now() + std::chrono::nanoseconds(timeout_ns);
        std::this_thread::sleep_until(std::min(asked, until));
        if (steady_clock::now() < until) {
            return SLUICE_TIMEOUT;
        }
        sluice_shim_control.stall_value = stalled = 0;
        return SLUICE_TIMEOUT;
    }
    if (value >= sluice_shim_control.time_out_from && value <= sluice_shim_control.time_out_to) {
        return SLUICE_TIMEOUT;
    }
    return sluice_shim_control.drop_host_wait ? SLUICE_OK : real->timeline_wait(renderer, value, timeout_ns);
}

SluiceResult resize(SluiceRenderer* renderer, std::uint32_t width, std::uint32_t height, SluiceError* error) {
    if (sluice_shim_control.fail_resizes > 0) {
        --sluice_shim_control.fail_resizes;
        return refuse(error, SLUICE_ERROR_OUT_OF_MEMORY, "the shim finds no memory for these images");
    }
    return real->resize(renderer, width, height, error);
}

SluiceResult setParticles(SluiceRenderer* renderer, const SluiceParticles* particles, SluiceError* error) {
    sluice_shim_control.particles = particles->count;
    sluice_shim_control.first_coordinate = particles->position[0];
    return real->set_particles(renderer, particles, error);
}

SluiceResult setEnvironment(SluiceRenderer* renderer, const SluiceEnvironment* environment, SluiceError* error) {
    sluice_shim_control.environment_width = environment != nullptr ? environment->width : 0;
    return real->set_environment(renderer, environment, error);
}

void destroy(SluiceRenderer* renderer) {
    sluice_shim_control.destroys += renderer != nullptr ? 1 : 0;
    real->destroy(renderer);
}

}  // namespace

extern "C" SLUICE_SHIM_EXPORT const SluiceRendererApi* sluice_renderer_entry(std::uint32_t abi_version) {
    // Kept open for as long as the process lives: the table that it gave away points into it.
    void* library = dlopen(SLUICE_REAL_RENDERER, RTLD_NOW | RTLD_LOCAL);
    void* symbol = library != nullptr ? dlsym(library, SLUICE_RENDERER_ENTRY_SYMBOL) : nullptr;
    if (symbol == nullptr) {
        return nullptr;
    }
    real = reinterpret_cast<SluiceRendererEntry>(symbol)(abi_version);
    if (real == nullptr) {
        return nullptr;
    }
    table = *real;
    table.struct_size = std::min<std::uint32_t>(real->struct_size, sizeof(table));
    table.create = create;
    table.info = info;
    table.resize = resize;
    table.set_particles = setParticles;
    table.set_environment = setEnvironment;
    table.submit_frame = submitFrame;
    table.poll = poll;
    table.timeline_wait = timelineWait;
    table.destroy = destroy;
    return &table;
}
