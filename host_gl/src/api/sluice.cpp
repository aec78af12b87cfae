// SPDX-License-Identifier: MIT
// The C API: arguments checked, exceptions stopped, everything else is the Session's.
#include "sluice/sluice.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <string>
#include <utility>

#include "api/log_sink.hpp"
#include "api/session.hpp"
#include "api/struct_sizes.hpp"
#include "api/water.hpp"
#include "sluice/defaults.hpp"

struct Sluice {
    std::unique_ptr<sluice::host::Session> session;
};

namespace {

using sluice::Error;
using sluice::Status;
using sluice::host::Once;

/// Of sluice_create.
std::string& createError() {
    thread_local std::string text;
    return text;
}

/// Runs `body`, which returns a Status; nothing is thrown.
template <typename Body>
SluiceResult call(Sluice* fluid, Body body, Once once = Once::Kind) noexcept {
    if (fluid == nullptr) {
        return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    try {
        sluice::host::Session& session = *fluid->session;
        Status status;
        try {
            status = body(session);
        } catch (const std::bad_alloc&) {
            status = Error{SLUICE_ERROR_OUT_OF_MEMORY, "Sluice", "out of memory", ""};
        } catch (const std::exception& thrown) {
            status = Error{SLUICE_ERROR_INTERNAL, "Sluice", thrown.what(), ""};
        }
        return session.told(status, once);
    } catch (...) {
        return SLUICE_ERROR_OUT_OF_MEMORY;  // there was none even for the message
    }
}

SluiceOptions defaultOptions() {
    auto options = sluice::sized<SluiceOptions>();
    options.api_version = SLUICE_API_VERSION;
    options.process = SLUICE_PROCESS_OWN;
    options.timeline = SLUICE_TIMELINE_AUTO;
    options.frame_deadline = 5.0;
    options.start_deadline = 120.0;
    return options;
}

Status checkOptions(const SluiceOptions& options) {
    if (options.api_version >> 16U != SLUICE_API_MAJOR) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, "options.api_version",
                     fmt::format("expected major {}, found {}", SLUICE_API_MAJOR, options.api_version >> 16U),
                     "set it to SLUICE_API_VERSION, or build the engine again"};
    }
    if (options.process > SLUICE_PROCESS_SAME) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "options.process", fmt::format("{} is none", options.process), ""};
    }
    if (options.timeline >= SLUICE_TIMELINE_UNSYNCHRONISED) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "options.timeline", fmt::format("{} is none", options.timeline),
                     "SLUICE_TIMELINE_AUTO is right"};
    }
    if (options.width > SLUICE_MAX_EXTENT || options.height > SLUICE_MAX_EXTENT) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "options.width and height",
                     fmt::format("expected at most {}, found {}x{}", SLUICE_MAX_EXTENT, options.width, options.height),
                     ""};
    }
    return {};
}

Status create(const SluiceOptions* given, Sluice** fluid, SluiceOptions& options) {
    if (Status status = sluice::checkAbiStruct(given, "options"); !status) {
        return status;
    }
    options = sluice::readAbiStruct(*given);
    if (Status status = checkOptions(options); !status) {
        return status;
    }
    sluice::Result<std::unique_ptr<sluice::host::Session>> made = sluice::host::Session::create(options);
    if (!made) {
        return made.error();
    }
    *fluid = std::make_unique<Sluice>(Sluice{std::move(made).value()}).release();
    return {};
}

}  // namespace

extern "C" {

uint32_t sluice_api_version(void) {
    return SLUICE_API_VERSION;
}

void sluice_options_defaults(SluiceOptions* options, size_t struct_size) {
    sluice::writeDefaults(options, defaultOptions(), struct_size);
}

SluiceResult sluice_create(const SluiceOptions* options, Sluice** fluid) {
    if (fluid == nullptr) {
        return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    *fluid = nullptr;
    try {
        SluiceOptions known = defaultOptions();
        Status status;
        try {
            status = create(options, fluid, known);
        } catch (const std::bad_alloc&) {
            status = Error{SLUICE_ERROR_OUT_OF_MEMORY, "sluice_create", "out of memory", ""};
        } catch (const std::exception& thrown) {
            status = Error{SLUICE_ERROR_INTERNAL, "sluice_create", thrown.what(), ""};
        }
        if (status) {
            return SLUICE_OK;
        }
        createError() = status.error().message();
        sluice::host::logSink(known)(SLUICE_LOG_ERROR, createError());
        return status.error().code;
    } catch (...) {
        return SLUICE_ERROR_OUT_OF_MEMORY;
    }
}

SluiceResult sluice_resize(Sluice* fluid, uint32_t width, uint32_t height) {
    return call(fluid, [&](sluice::host::Session& session) { return session.resize(width, height); });
}

SluiceResult sluice_begin_frame(Sluice* fluid, const float* view, const float* projection, double time) {
    return call(fluid, [&](sluice::host::Session& session) { return session.beginFrame(view, projection, time); });
}

SluiceResult sluice_set_camera(Sluice* fluid, const float* view, const float* projection) {
    return call(fluid, [&](sluice::host::Session& session) { return session.setCamera(view, projection); });
}

SluiceResult sluice_end_frame(Sluice* fluid) {
    return call(fluid, [](sluice::host::Session& session) { return session.endFrame(); });
}

void sluice_destroy(Sluice* fluid) {
    try {
        delete fluid;
    } catch (...) {
        // A log callback that throws; what it was told is lost.
    }
}

void sluice_water_defaults(SluiceWater* water, size_t struct_size) {
    sluice::writeDefaults(water, sluice::host::defaultWater(), struct_size);
}

SluiceResult sluice_set_water(Sluice* fluid, const SluiceWater* water) {
    return call(
        fluid, [&](sluice::host::Session& session) { return session.setWater(water); }, Once::Text);
}

void sluice_flow_of(const SluiceWater* water, SluiceFlow* flow, size_t struct_size) {
    const bool readable = water != nullptr && sluice::checkAbiStruct(water, "water");
    const SluiceWater known = readable ? sluice::readAbiStruct(*water) : sluice::host::defaultWater();
    sluice::writeDefaults(flow, sluice::host::flowOf(known), struct_size);
}

SluiceResult sluice_set_flow(Sluice* fluid, const SluiceFlow* flow) {
    return call(fluid, [&](sluice::host::Session& session) { return session.setFlow(flow); });
}

SluiceResult sluice_set_body(Sluice* fluid, uint32_t body, const SluiceBodyTarget* target) {
    return call(fluid, [&](sluice::host::Session& session) { return session.setBody(body, target); });
}

SluiceResult sluice_bodies(Sluice* fluid, SluiceBodies* bodies) {
    return call(fluid, [&](sluice::host::Session& session) { return session.bodies(bodies); });
}

void sluice_look_defaults(SluiceFluid* look) {
    if (look != nullptr) {
        *look = sluice::defaultFluid();
    }
}

SluiceResult sluice_set_look(Sluice* fluid, const SluiceFluid* look) {
    return call(fluid, [&](sluice::host::Session& session) {
        session.setLook(look != nullptr ? *look : sluice::defaultFluid());
        return Status{};
    });
}

SluiceResult sluice_set_other_looks(Sluice* fluid, const SluiceLook* looks, uint32_t count) {
    return call(fluid, [&](sluice::host::Session& session) { return session.setOtherLooks({looks, count}); });
}

void sluice_sky_defaults(SluiceSky* sky) {
    if (sky != nullptr) {
        *sky = sluice::defaultSky();
    }
}

SluiceResult sluice_set_sky(Sluice* fluid, const SluiceSky* sky) {
    return call(fluid, [&](sluice::host::Session& session) {
        session.setSky(sky != nullptr ? *sky : sluice::defaultSky());
        return Status{};
    });
}

SluiceResult sluice_set_environment(Sluice* fluid, const SluiceEnvironment* environment) {
    return call(fluid, [&](sluice::host::Session& session) { return session.setEnvironment(environment); });
}

SluiceResult sluice_set_enabled(Sluice* fluid, uint32_t enabled) {
    return call(fluid, [&](sluice::host::Session& session) {
        session.setEnabled(enabled != 0);
        return Status{};
    });
}

const char* sluice_last_error(const Sluice* fluid) {
    return fluid != nullptr ? fluid->session->lastError() : createError().c_str();
}

SluiceResult sluice_statistics(Sluice* fluid, SluiceStatistics* statistics) {
    return call(fluid, [&](sluice::host::Session& session) -> Status {
        const sluice::Result<SluiceStatistics> found = session.statistics();
        return found ? sluice::writeAbiStruct(statistics, found.value(), "statistics") : Status{found.error()};
    });
}

}  // extern "C"
