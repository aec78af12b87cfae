// SPDX-License-Identifier: MIT
#include "share/canary_gl.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "screen/gl_guards.hpp"
#include "share/gl_errors.hpp"
#include "share/imported_image.hpp"
#include "share/told_fd.hpp"
#include "sluice/canary.hpp"
#include "sluice/fd.hpp"
#include "sluice/format.hpp"

namespace sluice::host {

namespace {

Status exchangePatterns(const ImportedImage& image, const FormatInfo& format, std::uint32_t seed) {
    const SluiceImageExport& size = image.description();
    const std::string thing = fmt::format("canary of {} at {}x{}", format.name, size.width, size.height);
    const PixelGuard pixels;
    const TextureGuard texture;
    glBindTexture(GL_TEXTURE_2D, image.texture());
    std::vector<std::byte> found(std::size_t{size.width} * size.height * format.bytes_per_texel);
    glGetTexImage(GL_TEXTURE_2D, 0, format.gl_transfer_format, format.gl_transfer_type, found.data());
    if (const std::string errors = takeGlErrors(); !errors.empty()) {
        return Error{SLUICE_ERROR_CANARY, thing, fmt::format("reading the texture raised {}", errors), ""};
    }
    if (Status same = canaryCompare(format.format, size.width, size.height, seed, found); !same) {
        Error error = same.error();
        error.code = SLUICE_ERROR_CANARY;
        return error;
    }
    const std::vector<std::byte> answer = canaryPattern(format.format, size.width, size.height, seed + 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, static_cast<GLsizei>(size.width), static_cast<GLsizei>(size.height),
                    format.gl_transfer_format, format.gl_transfer_type, answer.data());
    glFinish();
    if (const std::string errors = takeGlErrors(); !errors.empty()) {
        return Error{SLUICE_ERROR_CANARY, thing, fmt::format("writing the texture raised {}", errors), ""};
    }
    return {};
}

}  // namespace

Status runCanary(const SluiceImageExport& image, std::uint32_t seed, ledger::ShareFeed* feed) {
    // The descriptor must survive a texel that differs, so the import consumes a duplicate.
    UniqueFd given(image.fd);
    ToldFd copy(given.duplicate(), feed);
    static_cast<void>(given.release());
    if (image.fd >= 0 && !copy.valid()) {
        return Error{SLUICE_ERROR_IMPORT, "canary", fmt::format("file descriptor {} cannot be duplicated", image.fd),
                     "raise the limit of open files (ulimit -n) or look for a leak"};
    }
    SluiceImageExport duplicate = image;
    duplicate.fd = copy.get();
    Result<ImportedImage> imported = importImage(duplicate, feed);
    if (!imported) {
        return imported.error();
    }
    copy.closedElsewhere();
    if (Status status = exchangePatterns(imported.value(), *findFormat(image.format), seed); !status) {
        return status;
    }
    if (feed != nullptr) {
        feed->closed(image.fd);
    }
    UniqueFd{image.fd}.reset();
    return {};
}

}  // namespace sluice::host
