// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <span>

#include "screen/gl_guards.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/context.hpp"

namespace sluice::host {
namespace {

constexpr GLsizei kProbeSize = 4;  ///< texels; smaller than this some drivers take other paths

bool atLeast(int version, const char* extension) {
    return epoxy_gl_version() >= version || (extension != nullptr && epoxy_has_gl_extension(extension));
}

std::uint32_t has(const char* extension) {
    return epoxy_has_gl_extension(extension) ? 1U : 0U;
}

void copyString(std::span<char> target, GLenum name) {
    // GLubyte is unsigned char by definition of the API, and these strings are ASCII.
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    if (text != nullptr) {
        std::strncpy(target.data(), text, target.size() - 1);
    }
}

void queryUuids(SluiceHostCapabilities& caps) {
    if (caps.has_memory_object == 0 && caps.has_semaphore == 0) {
        return;
    }
    GLint count = 0;
    glGetIntegerv(GL_NUM_DEVICE_UUIDS_EXT, &count);
    caps.device_uuid_count =
        std::min(static_cast<std::uint32_t>(std::max(count, 0)), static_cast<std::uint32_t>(SLUICE_MAX_DEVICE_UUIDS));
    for (std::uint32_t i = 0; i < caps.device_uuid_count; ++i) {
        glGetUnsignedBytei_vEXT(GL_DEVICE_UUID_EXT, i, &caps.device_uuids[i][0]);
    }
    glGetUnsignedBytevEXT(GL_DRIVER_UUID_EXT, &caps.driver_uuid[0]);
}

GLenum attachmentOf(TexelKind kind) {
    switch (kind) {
        case TexelKind::Depth:
            return GL_DEPTH_ATTACHMENT;
        case TexelKind::DepthStencil:
            return GL_DEPTH_STENCIL_ATTACHMENT;
        default:
            return GL_COLOR_ATTACHMENT0;
    }
}

bool frameBufferComplete(GLuint texture, TexelKind kind) {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachmentOf(kind), GL_TEXTURE_2D, texture, 0);
    if (kind == TexelKind::Depth || kind == TexelKind::DepthStencil) {
        // GL before 4.1 calls a framebuffer incomplete when its draw buffer names nothing.
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    }
    const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glDeleteFramebuffers(1, &framebuffer);
    return complete && glGetError() == GL_NO_ERROR;
}

void probeFormat(const FormatInfo& format, SluiceHostCapabilities& caps) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format.gl_internal), kProbeSize, kProbeSize, 0,
                 format.gl_transfer_format, format.gl_transfer_type, nullptr);
    GLint width = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    if (glGetError() == GL_NO_ERROR && width == kProbeSize) {
        caps.texture_formats |= formatBit(format.format);
        if (caps.has_framebuffer_object != 0 && frameBufferComplete(texture, format.kind)) {
            caps.attachment_formats |= formatBit(format.format);
        }
    }
    glDeleteTextures(1, &texture);
    clearGlErrors();
}

void probeFormats(SluiceHostCapabilities& caps) {
    const TextureGuard texture;
    const PixelGuard pixels;
    for (const FormatInfo& format : formatTable()) {
        if (caps.has_framebuffer_object != 0) {
            const FramebufferGuard framebuffer;
            probeFormat(format, caps);
        } else {
            probeFormat(format, caps);
        }
    }
}

}  // namespace

SluiceHostCapabilities queryCapabilities() {
    clearGlErrors();
    SluiceHostCapabilities caps{};
    caps.struct_size = sizeof(caps);
    copyString(caps.vendor, GL_VENDOR);
    copyString(caps.renderer, GL_RENDERER);
    copyString(caps.version, GL_VERSION);
    caps.has_memory_object = has("GL_EXT_memory_object");
    caps.has_memory_object_fd = has("GL_EXT_memory_object_fd");
    caps.has_semaphore = has("GL_EXT_semaphore");
    caps.has_semaphore_fd = has("GL_EXT_semaphore_fd");
    caps.has_timeline_semaphore = has("GL_NV_timeline_semaphore");
    caps.has_sync = atLeast(32, "GL_ARB_sync") ? 1U : 0U;
    caps.has_framebuffer_object = atLeast(30, "GL_ARB_framebuffer_object") ? 1U : 0U;
    queryUuids(caps);
    probeFormats(caps);
    clearGlErrors();
    return caps;
}

}  // namespace sluice::host
