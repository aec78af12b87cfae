// SPDX-License-Identifier: MIT
#include "timeline/gl_semaphore.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <string>

#include "screen/gl_guards.hpp"
#include "share/gl_errors.hpp"
#include "share/sized.hpp"

namespace sluice::host {

namespace {

// OpenGL registry, GL_NV_timeline_semaphore.
constexpr GLenum kTimelineValue = 0x9595;  // GL_TIMELINE_SEMAPHORE_VALUE_NV
constexpr GLenum kType = 0x95B3;           // GL_SEMAPHORE_TYPE_NV
constexpr GLint kTypeTimeline = 0x95B5;    // GL_SEMAPHORE_TYPE_TIMELINE_NV

std::vector<GLenum> generalLayouts(std::size_t count) {
    return std::vector<GLenum>(count, GL_LAYOUT_GENERAL_EXT);
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
    if (semaphore_ != 0) {
        glDeleteSemaphoresEXT(1, &semaphore_);
    }
}

Result<GlSemaphore> GlSemaphore::import(UniqueFd fd, const NvTimelineFunctions* timeline) {
    clearGlErrors();
    GlSemaphore semaphore;
    if (timeline != nullptr) {
        timeline->create(1, &semaphore.semaphore_);
        // The type must be set before the import.
        timeline->parameteriv(semaphore.semaphore_, kType, &kTypeTimeline);
    } else {
        glGenSemaphoresEXT(1, &semaphore.semaphore_);
    }
    glImportSemaphoreFdEXT(semaphore.semaphore_, GL_HANDLE_TYPE_OPAQUE_FD_EXT, fd.get());
    if (const std::string errors = takeGlErrors(); !errors.empty()) {
        return Error{SLUICE_ERROR_IMPORT, "import of a semaphore", fmt::format("OpenGL raised {}", errors),
                     "request the bridged timeline"};
    }
    static_cast<void>(fd.release());  // GL's from now on
    return semaphore;
}

void GlSemaphore::setValue(std::uint64_t value) const {
    const GLuint64 number = value;
    glSemaphoreParameterui64vEXT(semaphore_, kTimelineValue, &number);
}

void GlSemaphore::signal(std::span<const std::uint32_t> textures) const {
    const std::vector<GLenum> layouts = generalLayouts(textures.size());
    glSignalSemaphoreEXT(semaphore_, 0, nullptr, static_cast<GLuint>(textures.size()), textures.data(), layouts.data());
    glFlush();
}

void GlSemaphore::wait(std::span<const std::uint32_t> textures) const {
    const std::vector<GLenum> layouts = generalLayouts(textures.size());
    glWaitSemaphoreEXT(semaphore_, 0, nullptr, static_cast<GLuint>(textures.size()), textures.data(), layouts.data());
}

Result<UniqueFd> exportTimeline(const TimelineDeps& deps, SluiceDirection direction, std::uint64_t value) {
    SluiceError said = sized<SluiceError>();
    std::int32_t fd = -1;
    const SluiceResult result = deps.api->timeline_export(deps.renderer, direction, value, &fd, &said);
    if (result != SLUICE_OK || fd < 0) {
        return rendererError("timeline_export", result, said);
    }
    return UniqueFd(fd);
}

}  // namespace sluice::host
