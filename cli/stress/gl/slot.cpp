// SPDX-License-Identifier: MIT
#include "stress/gl/slot.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "share/gl_errors.hpp"
#include "sluice/format.hpp"

namespace sluice::stress {

SluiceFormat formatFor(Resource resource) {
    return resource == Resource::Colour ? SLUICE_FORMAT_RGBA8
           : resource == Resource::D32F ? SLUICE_FORMAT_D32F
                                        : SLUICE_FORMAT_R32F;
}

Result<std::unique_ptr<GlSlot>> GlSlot::create(const Storage& storage, std::uint32_t slot, ExportedSlot* exported) {
    auto made = std::make_unique<GlSlot>();
    Status status = storage.resource == Resource::Buffer ? made->createBuffer(storage, exported)
                                                         : made->createTexture(storage, slot, exported);
    if (!status) {
        return status.error();
    }
    return made;
}

Status GlSlot::createTexture(const Storage& storage, std::uint32_t slot, ExportedSlot* exported) {
    const SluiceFormat format = formatFor(storage.resource);
    if (exported != nullptr) {
        SluiceImageExport image{};
        image.struct_size = sizeof(image);
        // Role and set serve messages only.
        image.role = slot < storage.slots.shape.sets ? SLUICE_IMAGE_HOST_COLOUR : SLUICE_IMAGE_FLUID_COLOUR;
        image.image_set = slot % SLUICE_MAX_IMAGE_SETS;
        image.format = static_cast<std::uint32_t>(format);
        image.width = storage.width;
        image.height = storage.height;
        image.allocation_size = exported->bytes;
        image.fd = exported->fd.get();
        image.dedicated = 1;
        auto imported = host::importImage(image);
        if (!imported) {
            return imported.error();
        }
        (void)exported->fd.release();  // consumed
        imported_ = std::move(imported).value();
    } else {
        const FormatInfo& info = *findFormat(static_cast<std::uint32_t>(format));
        glGenTextures(1, &texture_);
        glBindTexture(GL_TEXTURE_2D, texture_);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(info.gl_internal), static_cast<GLsizei>(storage.width),
                     static_cast<GLsizei>(storage.height), 0, info.gl_transfer_format, info.gl_transfer_type, nullptr);
    }
    const bool depth = storage.resource == Resource::D32F;
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, depth ? GL_DEPTH_ATTACHMENT : GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture(),
                           0);
    if (depth) {
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    }
    const GLenum complete = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    const std::string errors = host::takeGlErrors();
    if (complete != GL_FRAMEBUFFER_COMPLETE || !errors.empty()) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("drawing into {} in OpenGL", toString(storage.resource)),
                     fmt::format("framebuffer status {:#x} {}", complete, errors), ""};
    }
    return {};
}

Status GlSlot::createBuffer(const Storage& storage, ExportedSlot* exported) {
    const auto bytes = static_cast<GLsizeiptr>(storage.texels()) * 4;
    glGenBuffers(1, &buffer_);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
    if (exported != nullptr) {
        glCreateMemoryObjectsEXT(1, &memory_);
        const GLint yes = GL_TRUE;
        glMemoryObjectParameterivEXT(memory_, GL_DEDICATED_MEMORY_OBJECT_EXT, &yes);
        // The driver's from here on, whatever it makes of it; Mesa closes it even when it refuses.
        glImportMemoryFdEXT(memory_, exported->bytes, GL_HANDLE_TYPE_OPAQUE_FD_EXT, exported->fd.release());
        glBufferStorageMemEXT(GL_SHADER_STORAGE_BUFFER, bytes, memory_, 0);
    } else {
        glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_DYNAMIC_COPY);
    }
    GLint size = 0;
    glGetBufferParameteriv(GL_SHADER_STORAGE_BUFFER, GL_BUFFER_SIZE, &size);
    const std::string errors = host::takeGlErrors();
    if (!errors.empty() || size != bytes) {
        return Error{SLUICE_ERROR_IMPORT, fmt::format("import of a buffer of {} bytes", bytes),
                     fmt::format("OpenGL has {} bytes {}", size, errors), "the memory is of another device or kind"};
    }
    return {};
}

GlSlot::~GlSlot() {
    glDeleteFramebuffers(1, &framebuffer_);  // zeros are ignored
    glDeleteTextures(1, &texture_);
    glDeleteBuffers(1, &buffer_);
    if (memory_ != 0) {
        glDeleteMemoryObjectsEXT(1, &memory_);
    }
}

}  // namespace sluice::stress
