// SPDX-License-Identifier: MIT
#include "timeline/gl_semaphore.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <string>

#include "context/profile.hpp"
#include "share/gl_errors.hpp"
#include "share/renderer_error.hpp"
#include "share/told_fd.hpp"
#include "sluice/abi_sizes.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

// OpenGL registry, GL_NV_timeline_semaphore.
constexpr GLenum kTimelineValue = 0x9595;  // GL_TIMELINE_SEMAPHORE_VALUE_NV
constexpr GLenum kType = 0x95B3;           // GL_SEMAPHORE_TYPE_NV
constexpr GLint kTypeTimeline = 0x95B5;    // GL_SEMAPHORE_TYPE_TIMELINE_NV

std::vector<GLenum> generalLayouts(std::size_t count) {
    std::vector<GLenum> layouts(count, GL_LAYOUT_GENERAL_EXT);
    return layouts;
}

/// What `call`, made inside a GlErrorScope, was refused for.
Status refusalOf(const char* call) {
    const std::string raised = GlErrorScope::take();
    if (raised.empty()) {
        return {};
    }
    return Error{SLUICE_ERROR_INTERNAL, call, fmt::format("OpenGL raised {}", raised), "request the bridged timeline"};
}

/// Asks the renderer for the descriptor of (direction, value).
Result<UniqueFd> exportTimeline(const TimelineDeps& deps, SluiceDirection direction, std::uint64_t value) {
    auto said = sized<SluiceError>();
    std::int32_t fd = -1;
    const SluiceResult result = deps.api->timeline_export(deps.renderer, direction, value, &fd, &said);
    if (result != SLUICE_OK || fd < 0) {
        return rendererError("timeline_export", result, said);
    }
    return UniqueFd(fd);
}

}  // namespace

std::optional<NvTimelineFunctions> loadNvTimelineFunctions() {
    if (!epoxy_has_gl_extension("GL_NV_timeline_semaphore")) {
        return std::nullopt;
    }
    NvTimelineFunctions functions{};
    functions.create = reinterpret_cast<decltype(functions.create)>(eglGetProcAddress("glCreateSemaphoresNV"));
    functions.parameteriv =
        reinterpret_cast<decltype(functions.parameteriv)>(eglGetProcAddress("glSemaphoreParameterivNV"));
    if (functions.create == nullptr || functions.parameteriv == nullptr) {
        return std::nullopt;
    }
    return functions;
}

GlSemaphore::~GlSemaphore() {
    if (semaphore_ != 0 && !glGone()) {
        glDeleteSemaphoresEXT(1, &semaphore_);
    }
}

Result<GlSemaphore> GlSemaphore::import(const TimelineDeps& deps, SluiceDirection direction, std::uint64_t value,
                                        const NvTimelineFunctions* timeline) {
    Result<UniqueFd> exported = exportTimeline(deps, direction, value);
    if (!exported) {
        return exported.error();
    }
    ToldFd fd(std::move(exported).value(), deps.shares);
    const GlErrorScope errors;
    GlSemaphore semaphore;
    if (timeline != nullptr) {
        timeline->create(1, &semaphore.semaphore_);
        // The type must be set before the import.
        timeline->parameteriv(semaphore.semaphore_, kType, &kTypeTimeline);
    } else {
        glGenSemaphoresEXT(1, &semaphore.semaphore_);
    }
    glImportSemaphoreFdEXT(semaphore.semaphore_, GL_HANDLE_TYPE_OPAQUE_FD_EXT, fd.get());
    if (const std::string raised = GlErrorScope::take(); !raised.empty()) {
        return Error{SLUICE_ERROR_IMPORT, "import of a semaphore", fmt::format("OpenGL raised {}", raised),
                     "request the bridged timeline"};
    }
    fd.given();
    return semaphore;
}

Status GlSemaphore::setValue(std::uint64_t value) const {
    const GlErrorScope errors;
    const GLuint64 number = value;
    glSemaphoreParameterui64vEXT(semaphore_, kTimelineValue, &number);
    return refusalOf("glSemaphoreParameterui64vEXT");
}

Status GlSemaphore::signal(std::span<const std::uint32_t> textures) const {
    const GlErrorScope errors;
    const std::vector<GLenum> layouts = generalLayouts(textures.size());
    glSignalSemaphoreEXT(semaphore_, 0, nullptr, static_cast<GLuint>(textures.size()), textures.data(), layouts.data());
    glFlush();
    return refusalOf("glSignalSemaphoreEXT");
}

Status GlSemaphore::wait(std::span<const std::uint32_t> textures) const {
    const GlErrorScope errors;
    const std::vector<GLenum> layouts = generalLayouts(textures.size());
    glWaitSemaphoreEXT(semaphore_, 0, nullptr, static_cast<GLuint>(textures.size()), textures.data(), layouts.data());
    return refusalOf("glWaitSemaphoreEXT");
}

Status signalRenderer(const GlSemaphore& semaphore, std::uint64_t value, std::uint64_t begin,
                      std::span<const std::uint32_t> textures, Trace* trace) {
    Status status = semaphore.signal(textures);
    if (status) {
        traceStep(trace, SLUICE_TRACE_SIGNAL, SLUICE_TRACK_HOST_CPU, SLUICE_HOST_TO_RENDERER, value, begin,
                  "signal renderer");
    }
    return status;
}

Status waitForRenderer(const GlSemaphore& semaphore, std::uint64_t value, std::uint64_t begin,
                       std::span<const std::uint32_t> textures, Trace* trace) {
    Status status = semaphore.wait(textures);
    if (status) {
        traceStep(trace, SLUICE_TRACE_WAIT, SLUICE_TRACK_HOST_CPU, SLUICE_RENDERER_TO_HOST, value, begin,
                  "wait for renderer");
    }
    return status;
}

}  // namespace sluice::host
