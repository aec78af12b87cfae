// SPDX-License-Identifier: MIT
// The few functions of OpenGL, GLX and EGL that the payload itself calls, past all hooks.
#pragma once

#include <cstdint>
#include <string>

#include "payload_abi.h"

namespace sluice::inject {

/// NULL where the program has no such function.
struct GlCalls {
    std::uint32_t (*getError)() = nullptr;
    void (*getIntegerv)(std::uint32_t, std::int32_t*) = nullptr;
    void (*getFloatv)(std::uint32_t, float*) = nullptr;
    const unsigned char* (*getString)(std::uint32_t) = nullptr;
    void (*getAttachment)(std::uint32_t, std::uint32_t, std::uint32_t, std::int32_t*) = nullptr;
    void (*bindFramebuffer)(std::uint32_t, std::uint32_t) = nullptr;
    std::uint8_t (*isProgram)(std::uint32_t) = nullptr;
    void (*getProgramiv)(std::uint32_t, std::uint32_t, std::int32_t*) = nullptr;
    void (*getActiveUniform)(std::uint32_t, std::uint32_t, std::int32_t, std::int32_t*, std::int32_t*, std::uint32_t*,
                             char*) = nullptr;
    std::int32_t (*getUniformLocation)(std::uint32_t, const char*) = nullptr;
    void (*getUniformfv)(std::uint32_t, std::int32_t, float*) = nullptr;
    void (*readPixels)(std::int32_t, std::int32_t, std::int32_t, std::int32_t, std::uint32_t, std::uint32_t,
                       void*) = nullptr;

    // Uniform blocks; all of them or none.
    void (*getActiveUniformsiv)(std::uint32_t, std::int32_t, const std::uint32_t*, std::uint32_t,
                                std::int32_t*) = nullptr;
    void (*getActiveUniformBlockiv)(std::uint32_t, std::uint32_t, std::uint32_t, std::int32_t*) = nullptr;
    void (*getIntegeri)(std::uint32_t, std::uint32_t, std::int32_t*) = nullptr;
    void (*bindBuffer)(std::uint32_t, std::uint32_t) = nullptr;
    void (*getBufferParameteriv)(std::uint32_t, std::uint32_t, std::int32_t*) = nullptr;
    void (*getBufferSubData)(std::uint32_t, std::intptr_t, std::intptr_t, void*) = nullptr;  ///< not in OpenGL ES
    void* (*mapBufferRange)(std::uint32_t, std::intptr_t, std::intptr_t, std::uint32_t) = nullptr;
    std::uint8_t (*unmapBuffer)(std::uint32_t) = nullptr;

    void* (*glxContext)() = nullptr;
    void* (*glxDisplay)() = nullptr;
    unsigned long (*glxDrawable)() = nullptr;
    void (*glxQueryDrawable)(void*, unsigned long, int, unsigned*) = nullptr;
    void* (*eglContext)() = nullptr;
    void* (*eglDisplay)() = nullptr;
    void* (*eglSurface)(int) = nullptr;
    unsigned (*eglSurfaceValue)(void*, void*, int, int*) = nullptr;
    unsigned (*eglConfigs)(void*, const int*, void**, int, int*) = nullptr;
    unsigned (*eglConfigValue)(void*, void*, int, int*) = nullptr;
    unsigned (*eglBindApi)(unsigned) = nullptr;
    unsigned (*eglQueryApi)() = nullptr;
    void* (*eglMakeContext)(void*, void*, void*, const int*) = nullptr;
    unsigned (*eglEndContext)(void*, void*) = nullptr;
    unsigned (*eglUse)(void*, void*, void*, void*) = nullptr;
};

[[nodiscard]] GlCalls loadGlCalls(const SluiceInjectShim& shim);

/// Of the calling thread.
struct CurrentContext {
    std::uint32_t api = SLUICE_INJECT_GLX;
    void* context = nullptr;  ///< NULL: none is current
    void* display = nullptr;
    std::uintptr_t drawable = 0;
};
[[nodiscard]] CurrentContext currentContext(const GlCalls& gl);

struct DrawableSize {
    std::uint32_t width = 0, height = 0;
    bool operator==(const DrawableSize&) const = default;
};
[[nodiscard]] DrawableSize drawableSize(const GlCalls& gl, const CurrentContext& current);

/// What a context and its default framebuffer are.
struct ContextFacts {
    std::string renderer, version;
    std::int32_t number = 0;  ///< 10 * major + minor
    bool embedded = false, compatibility = false, stereo = false, clip_control = false;
    std::int32_t depth_bits = 0, stencil_bits = 0, samples = 0;
};
[[nodiscard]] ContextFacts contextFacts(const GlCalls& gl);
/// Those of our own making; the program's must have been kept before.
void forgetErrors(const GlCalls& gl);

}  // namespace sluice::inject
