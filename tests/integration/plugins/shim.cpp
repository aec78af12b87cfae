// SPDX-License-Identifier: MIT
// The real renderer behind a table that fails where a test asks it to. One renderer at a time.
#include "plugins/shim.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>
#include <utility>

#include "sluice/plugin.h"

using sluice::host::test::Entry;
using sluice::host::test::ImageLie;
using sluice::host::test::InfoLie;
using sluice::host::test::ShimControl;
using sluice::host::test::StatsLie;

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

/// True when `entry` shall fail; `error` then gets a text that fills it to its last byte.
bool breaks(Entry entry, SluiceError* error) {
    if (sluice_shim_control.broken != entry) {
        return false;
    }
    if (error != nullptr) {
        error->code = SLUICE_ERROR_INTERNAL;
        std::memset(&error->message[0], 'x', sizeof(error->message));
    }
    return true;
}

SluiceResult (*share)(void*, const SluiceImageExport*, SluiceError*) = nullptr;

SluiceResult shareLying(void* user, const SluiceImageExport* image, SluiceError* error) {
    SluiceImageExport changed = *image;
    switch (sluice_shim_control.image_lie) {
        case ImageLie::Role:
            changed.role = 99;
            break;
        case ImageLie::OtherRole:
            changed.role = SLUICE_IMAGE_FLUID_DEPTH;
            break;
        case ImageLie::Set:
            changed.image_set = 99;
            break;
        case ImageLie::Format:
            changed.format = 99;
            break;
        case ImageLie::NoWidth:
            changed.width = 0;
            break;
        case ImageLie::TwiceAsWide:
            changed.width *= 2;
            break;
        case ImageLie::NoMemory: {
            changed.fd = open("/dev/null", O_RDWR | O_CLOEXEC);
            const SluiceResult result = share(user, &changed, error);
            // What was accepted is the host's; of the renderer's own descriptor the host knows nothing then.
            close(result == SLUICE_OK ? image->fd : changed.fd);
            return result;
        }
        case ImageLie::Tiny:
            changed.allocation_size = 1;
            break;
        case ImageLie::NotShared:
            close(image->fd);
            return SLUICE_OK;
        case ImageLie::NotDedicated:
            changed.dedicated = 0;
            break;
        case ImageLie::Larger:
            changed.allocation_size += 4096;
            break;
        case ImageLie::LostDescriptor: {
            changed.fd = fcntl(image->fd, F_DUPFD_CLOEXEC, 0);
            const SluiceResult result = share(user, &changed, error);
            ShimControl& control = sluice_shim_control;
            if (result == SLUICE_OK) {
                control.lost.at(control.lost_count++) = image->fd;
            } else {
                close(changed.fd);
            }
            return result;
        }
        case ImageLie::None:
            break;
    }
    return share(user, &changed, error);
}

SluiceResult create(const SluiceHostServices* host, const SluiceCreateInfo* info, SluiceRenderer** renderer,
                    SluiceError* error) {
    ShimControl& control = sluice_shim_control;
    if (control.attempt_count < control.attempts.size()) {
        control.attempts.at(control.attempt_count) = info->timeline;
    }
    ++control.attempt_count;
    if (breaks(Entry::Create, error)) {
        *renderer = nullptr;
        return SLUICE_ERROR_INTERNAL;
    }
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
    share = host->share_image;
    services.share_image = shareLying;
    return real->create(&services, &changed, renderer, error);
}

SluiceResult info(SluiceRenderer* renderer, SluiceRendererInfo* out) {
    if (breaks(Entry::Info, nullptr)) {
        return SLUICE_ERROR_INTERNAL;
    }
    const SluiceResult result = real->info(renderer, out);
    switch (sluice_shim_control.info_lie) {
        case InfoLie::Timeline:
            out->timeline = 77;
            break;
        case InfoLie::Sets:
            out->image_sets = 1'000'000'000;
            break;
        case InfoLie::Size:
            out->width = 0;
            break;
        case InfoLie::Format:
            out->formats[SLUICE_IMAGE_FLUID_COLOUR] = 12345;
            break;
        case InfoLie::Encoding:
            out->host_depth_encoding = 9;
            break;
        case InfoLie::EndlessNames:
            std::memset(&out->capabilities.device_name[0], 'n', sizeof(out->capabilities.device_name));
            std::memset(&out->capabilities.driver_name[0], 'n', sizeof(out->capabilities.driver_name));
            std::memset(&out->capabilities.driver_info[0], 'n', sizeof(out->capabilities.driver_info));
            break;
        case InfoLie::Device:
            out->capabilities.device_uuid[3] ^= 0xFFU;
            break;
        case InfoLie::Driver:
            out->capabilities.driver_uuid[3] ^= 0xFFU;
            break;
        case InfoLie::None:
            break;
    }
    if (result == SLUICE_OK && claimed != SLUICE_TIMELINE_AUTO) {
        out->timeline = claimed;
    }
    return result;
}

SluiceResult submitFrame(SluiceRenderer* renderer, const SluiceFrame* frame, SluiceError* error) {
    ++sluice_shim_control.submits;
    if (breaks(Entry::SubmitFrame, error)) {
        SluiceFrame refused = *frame;
        refused.outputs = UINT32_MAX;  // the real renderer has to hear of the frame's number
        (void)real->submit_frame(renderer, &refused, nullptr);
        return SLUICE_ERROR_INTERNAL;
    }
    if (frame->frame == sluice_shim_control.lose_submit ||
        sluice_shim_control.lose_submit == sluice::host::test::kAnyFrame) {
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
    if (breaks(Entry::Poll, nullptr)) {
        return SLUICE_ERROR_INTERNAL;
    }
    const SluiceResult result =
        frame == sluice_shim_control.lose_poll ? SLUICE_ERROR_DEVICE_LOST : real->poll(renderer, frame, stats);
    if (sluice_shim_control.stats_lie == StatsLie::PassCount) {
        stats->pass_count = 1'000'000'000;
    } else if (sluice_shim_control.stats_lie == StatsLie::EndlessNames) {
        for (SluicePassStats& pass : stats->passes) {
            std::memset(&pass.name[0], 'p', sizeof(pass.name));
        }
    }
    return result;
}

SluiceResult timelineWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
    ++sluice_shim_control.waits;
    if (breaks(Entry::TimelineWait, nullptr)) {
        return SLUICE_ERROR_INTERNAL;
    }
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
    if (breaks(Entry::Resize, error)) {
        return SLUICE_ERROR_INTERNAL;
    }
    if (sluice_shim_control.fail_resizes > 0) {
        --sluice_shim_control.fail_resizes;
        return refuse(error, SLUICE_ERROR_OUT_OF_MEMORY, "the shim finds no memory for these images");
    }
    return real->resize(renderer, width, height, error);
}

SluiceResult setParticles(SluiceRenderer* renderer, const SluiceParticles* particles, SluiceError* error) {
    if (breaks(Entry::SetParticles, error)) {
        return SLUICE_ERROR_INTERNAL;
    }
    if (particles->count != 0 && particles->count == sluice_shim_control.refuses_particles_of) {
        return refuse(error, SLUICE_ERROR_UNSUPPORTED, "the shim takes no such particles");
    }
    sluice_shim_control.particles = particles->count;
    sluice_shim_control.first_coordinate = particles->position[0];
    return real->set_particles(renderer, particles, error);
}

SluiceResult setFlow(SluiceRenderer* renderer, const SluiceFlow* flow, SluiceError* error) {
    if (flow->gravity[0] != 0.0F && flow->gravity[0] == sluice_shim_control.refuses_flow_of) {
        return refuse(error, SLUICE_ERROR_INVALID_ARGUMENT, "the shim takes no such flow");
    }
    sluice_shim_control.flow_gravity = flow->gravity[0];
    return real->set_flow(renderer, flow, error);
}

SluiceResult setEnvironment(SluiceRenderer* renderer, const SluiceEnvironment* environment, SluiceError* error) {
    if (breaks(Entry::SetEnvironment, error)) {
        return SLUICE_ERROR_INTERNAL;
    }
    if (environment != nullptr && environment->width == sluice_shim_control.refuses_environment_of) {
        return refuse(error, SLUICE_ERROR_UNSUPPORTED, "the shim takes no such environment");
    }
    sluice_shim_control.environment_width = environment != nullptr ? environment->width : 0;
    return real->set_environment(renderer, environment, error);
}

SluiceResult timelineSignal(SluiceRenderer* renderer, std::uint64_t value) {
    return breaks(Entry::TimelineSignal, nullptr) ? SLUICE_ERROR_INTERNAL : real->timeline_signal(renderer, value);
}

SluiceResult timelineValue(SluiceRenderer* renderer, std::uint32_t direction, std::uint64_t* value) {
    return breaks(Entry::TimelineValue, nullptr) ? SLUICE_ERROR_INTERNAL
                                                 : real->timeline_value(renderer, direction, value);
}

SluiceResult timelineExport(SluiceRenderer* renderer, std::uint32_t direction, std::uint64_t value, std::int32_t* fd,
                            SluiceError* error) {
    return breaks(Entry::TimelineExport, error) ? SLUICE_ERROR_INTERNAL
                                                : real->timeline_export(renderer, direction, value, fd, error);
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
    table.set_flow = setFlow;
    table.submit_frame = submitFrame;
    table.poll = poll;
    table.timeline_wait = timelineWait;
    table.timeline_signal = timelineSignal;
    table.timeline_value = timelineValue;
    table.timeline_export = timelineExport;
    table.destroy = destroy;
    return &table;
}
