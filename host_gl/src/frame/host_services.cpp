// SPDX-License-Identifier: MIT
#include "frame/host_services.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>

#include "share/canary_gl.hpp"
#include "share/sized.hpp"

namespace sluice::host {

namespace {

constexpr const char* kService = "host service";

/// Runs `body`; no exception crosses the ABI. Out of memory is the only one expected.
template <typename Body>
SluiceResult guarded(SluiceError* error, const Body& body) noexcept {
    try {
        const Status status = body();
        return status ? SLUICE_OK : tellError(error, status.error());
    } catch (const std::exception& caught) {
        try {
            return tellError(error, {SLUICE_ERROR_OUT_OF_MEMORY, kService, caught.what(), ""});
        } catch (...) {
            return SLUICE_ERROR_OUT_OF_MEMORY;
        }
    } catch (...) {
        return SLUICE_ERROR_INTERNAL;
    }
}

/// An export too short to say its descriptor has none; zero would be somebody's standard input.
SluiceImageExport readExport(const SluiceImageExport& given) {
    SluiceImageExport image = readSized(given);
    if (given.struct_size < offsetof(SluiceImageExport, fd) + sizeof(image.fd)) {
        image.fd = -1;
    }
    return image;
}

Error missingArgument() {
    return {SLUICE_ERROR_INVALID_ARGUMENT, kService, "the image is NULL", "the renderer is broken"};
}

}  // namespace

HostServices::HostServices(std::function<void(SluiceLogLevel, std::string_view)> log, Trace* trace)
    : log_(std::move(log)), trace_(trace) {
    table_.struct_size = sizeof(table_);
    table_.abi_version = SLUICE_ABI_VERSION;
    table_.user = this;
    table_.log = &HostServices::logService;
    table_.trace = trace != nullptr ? &HostServices::traceService : nullptr;
    table_.share_image = &HostServices::shareService;
    table_.retire_image = &HostServices::retireService;
    table_.canary = &HostServices::canaryService;
}

void HostServices::log(SluiceLogLevel level, std::string_view message) {
    if (log_) {
        const std::lock_guard lock(log_mutex_);
        log_(level, message);
    }
}

void HostServices::logService(void* user, std::int32_t level, const char* message) {
    if (user == nullptr || message == nullptr) {
        return;
    }
    static_cast<void>(guarded(nullptr, [&]() -> Status {
        const auto known =
            static_cast<SluiceLogLevel>(std::clamp<std::int32_t>(level, SLUICE_LOG_DEBUG, SLUICE_LOG_ERROR));
        static_cast<HostServices*>(user)->log(known, message);
        return {};
    }));
}

void HostServices::traceService(void* user, const SluiceTraceEvent* event) {
    if (user == nullptr || event == nullptr) {
        return;
    }
    SluiceTraceEvent copy = readSized(*event);
    if (copy.kind >= SLUICE_TRACE_KIND_COUNT || copy.track >= SLUICE_TRACK_COUNT) {
        return;
    }
    if (copy.name == nullptr) {
        copy.name = "";
    }
    static_cast<HostServices*>(user)->trace_->record(copy);
}

SluiceResult HostServices::shareService(void* user, const SluiceImageExport* image, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (user == nullptr || image == nullptr) {
            return missingArgument();
        }
        Result<ImportedImage> imported = importImage(readExport(*image));
        if (!imported) {
            return imported.error();
        }
        static_cast<HostServices*>(user)->images_.put(std::move(imported).value());
        return {};
    });
}

void HostServices::retireService(void* user, std::uint32_t role, std::uint32_t image_set) {
    if (user != nullptr) {
        static_cast<HostServices*>(user)->images_.retire(role, image_set);
    }
}

SluiceResult HostServices::canaryService(void* user, const SluiceImageExport* image, std::uint32_t seed,
                                         SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (user == nullptr || image == nullptr) {
            return missingArgument();
        }
        return runCanary(readExport(*image), seed);
    });
}

}  // namespace sluice::host
