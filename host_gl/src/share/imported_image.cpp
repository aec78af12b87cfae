// SPDX-License-Identifier: MIT
#include "share/imported_image.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <string>

#include "context/profile.hpp"
#include "screen/gl_guards.hpp"
#include "share/gl_errors.hpp"
#include "share/told_fd.hpp"
#include "sluice/fd.hpp"
#include "sluice/format.hpp"

namespace sluice::host {

namespace {

std::string describe(const SluiceImageExport& image, const FormatInfo* format) {
    // Not yet checked: a number outside the enumeration must not become one of it.
    const std::string_view role =
        image.role < SLUICE_IMAGE_ROLE_COUNT ? toString(static_cast<SluiceImageRole>(image.role)) : "unknown role";
    return fmt::format("import of {} set {} ({}x{} {})", role, image.image_set, image.width, image.height,
                       format != nullptr ? format->name : std::string_view("unknown format"));
}

Status checkDescription(const SluiceImageExport& image, const FormatInfo* format, const std::string& thing) {
    if (image.role >= SLUICE_IMAGE_ROLE_COUNT || image.image_set >= SLUICE_MAX_IMAGE_SETS || format == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing,
                     fmt::format("role {}, set {}, format {} is not an image of this ABI", image.role, image.image_set,
                                 image.format),
                     "the renderer is broken or newer than this host"};
    }
    if (image.width == 0 || image.height == 0 || image.width > SLUICE_MAX_EXTENT || image.height > SLUICE_MAX_EXTENT) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing,
                     fmt::format("expected 1..{} texels a side", SLUICE_MAX_EXTENT), ""};
    }
    if (image.fd < 0) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing, fmt::format("file descriptor {} is not open", image.fd), ""};
    }
    const std::uint64_t least = std::uint64_t{image.width} * image.height * format->bytes_per_texel;
    if (image.allocation_size < least) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing,
                     fmt::format("expected an allocation of at least {} bytes, found {}", least, image.allocation_size),
                     "allocation_size is the size of the whole VkDeviceMemory"};
    }
    if (!epoxy_has_gl_extension("GL_EXT_memory_object_fd") || !epoxy_has_gl_extension("GL_EXT_memory_object")) {
        return Error{SLUICE_ERROR_UNSUPPORTED, thing, "the GL driver has no GL_EXT_memory_object_fd",
                     "use a driver that can import memory"};
    }
    return {};
}

/// Mesa closes the descriptor of an import even when it reports an error, others leave it open. Closes `number` only if
/// it is still the file that `original` is.
void closeIfStillOpen(int number, int original) {
    struct stat left {};
    struct stat right {};
    if (fstat(number, &left) == 0 && fstat(original, &right) == 0 && left.st_dev == right.st_dev &&
        left.st_ino == right.st_ino) {
        UniqueFd{number}.reset();
    }
}

Status importMemory(GLuint memory, const SluiceImageExport& image, const std::string& thing, ledger::ShareFeed* feed) {
    if (image.dedicated != 0) {
        const GLint yes = GL_TRUE;
        glMemoryObjectParameterivEXT(memory, GL_DEDICATED_MEMORY_OBJECT_EXT, &yes);
    }
    // GL gets a duplicate, so that whatever it does with that one, the caller's is open until all has succeeded.
    UniqueFd original(image.fd);
    ToldFd copy(original.duplicate(), feed);
    static_cast<void>(original.release());
    if (!copy.valid()) {
        return Error{SLUICE_ERROR_IMPORT, thing, fmt::format("file descriptor {} cannot be duplicated", image.fd),
                     "raise the limit of open files (ulimit -n) or look for a leak"};
    }
    glImportMemoryFdEXT(memory, image.allocation_size, GL_HANDLE_TYPE_OPAQUE_FD_EXT, copy.get());
    if (const std::string errors = takeGlErrors(); !errors.empty()) {
        closeIfStillOpen(copy.gone(), image.fd);
        return Error{SLUICE_ERROR_IMPORT, thing, fmt::format("glImportMemoryFdEXT raised {}", errors),
                     "host and renderer must run on the same device and driver"};
    }
    copy.given();
    return {};
}

/// What GL says it was told, which need not be what it should have been. The texture must be bound.
ledger::MemoryFacts toldToGl(GLuint memory, const SluiceImageExport& image) {
    // A driver that does not answer leaves what it was told.
    GLint dedicated = image.dedicated != 0 ? GL_TRUE : GL_FALSE;
    GLint tiling = GL_OPTIMAL_TILING_EXT;
    glGetMemoryObjectParameterivEXT(memory, GL_DEDICATED_MEMORY_OBJECT_EXT, &dedicated);
    glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_TILING_EXT, &tiling);
    clearGlErrors();
    ledger::MemoryFacts facts;
    facts.size = image.allocation_size;  // GL has no query for it
    facts.tiling = tiling == GL_LINEAR_TILING_EXT ? 1 : 0;
    facts.dedicated = dedicated == GL_FALSE ? 0 : 1;
    return facts;
}

/// The texture must be bound. Mesa 22.3.6 raises no error for memory that is too small or no memory at all: the texture
/// is then left without storage, and only its size tells.
Status defineStorage(GLuint memory, const SluiceImageExport& image, const FormatInfo& format,
                     const std::string& thing) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_TILING_EXT, GL_OPTIMAL_TILING_EXT);
    glTexStorageMem2DEXT(GL_TEXTURE_2D, 1, format.gl_internal, static_cast<GLsizei>(image.width),
                         static_cast<GLsizei>(image.height), memory, 0);
    const std::string errors = takeGlErrors();
    GLint width = 0;
    GLint height = 0;
    GLint immutable = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
    glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_IMMUTABLE_FORMAT, &immutable);
    if (!errors.empty() || width != static_cast<GLint>(image.width) || height != static_cast<GLint>(image.height) ||
        immutable == 0) {
        return Error{SLUICE_ERROR_IMPORT, thing,
                     fmt::format("glTexStorageMem2DEXT left a texture of {}x{}, immutable {}{}{}", width, height,
                                 immutable, errors.empty() ? "" : ", and raised ", errors),
                     "the memory is too small, of another kind or of another device"};
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return {};
}

}  // namespace

ImportedImage::~ImportedImage() {
    if (glGone()) {
        return;
    }
    if (texture_ != 0) {
        glDeleteTextures(1, &texture_);
    }
    if (memory_ != 0) {
        glDeleteMemoryObjectsEXT(1, &memory_);
    }
}

Result<ImportedImage> importImage(const SluiceImageExport& image, ledger::ShareFeed* feed) {
    const FormatInfo* format = findFormat(image.format);
    const std::string thing = describe(image, format);
    if (Status status = checkDescription(image, format, thing); !status) {
        return status.error();
    }
    clearGlErrors();
    ImportedImage imported;
    imported.description_ = image;
    imported.description_.fd = -1;
    glCreateMemoryObjectsEXT(1, &imported.memory_);
    glGenTextures(1, &imported.texture_);
    if (Status status = importMemory(imported.memory_, image, thing, feed); !status) {
        return status.error();
    }
    const TextureGuard guard;
    glBindTexture(GL_TEXTURE_2D, imported.texture_);
    if (Status status = defineStorage(imported.memory_, image, *format, thing); !status) {
        return status.error();
    }
    if (feed != nullptr) {
        feed->imported(image, toldToGl(imported.memory_, image));
        feed->closed(image.fd);
    }
    UniqueFd{image.fd}.reset();  // accepted: what the contract calls ours is closed, GL holds its own
    return imported;
}

}  // namespace sluice::host
