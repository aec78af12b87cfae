// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include "builder.hpp"
#include "ending.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::particles {

namespace {

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

Error unreadable(const std::string& name, int code) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name,
            fmt::format("cannot be read: {}", std::generic_category().message(code)),
            "check the path and its permissions"};
}

Error tooLarge(const std::string& name, std::uint64_t bytes) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name,
            fmt::format("expected at most {} bytes, found {}{}", kMaxFileBytes,
                        bytes > kMaxFileBytes ? "" : "more than ", bytes),
            "split the set"};
}

/// A pipe or a device could block or never end, so only a regular file (or a link to one) is opened for good.
/// Without O_NONBLOCK, opening a pipe that nobody writes to would wait before it can be looked at.
Result<std::unique_ptr<std::FILE, Close>> openFile(const std::filesystem::path& path, const std::string& name,
                                                   std::uint64_t& size) {
    const int fd = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        return unreadable(name, errno);
    }
    std::unique_ptr<std::FILE, Close> file(fdopen(fd, "rb"));
    if (!file) {
        const int code = errno;
        close(fd);
        return unreadable(name, code);
    }
    struct stat info {};
    if (fstat(fd, &info) != 0) {
        return unreadable(name, errno);
    }
    if (S_ISDIR(info.st_mode)) {
        return unreadable(name, EISDIR);
    }
    if (!S_ISREG(info.st_mode)) {
        return Error{
            SLUICE_ERROR_INVALID_ARGUMENT, name,
            fmt::format("expected a regular file, found a {}", S_ISFIFO(info.st_mode) ? "pipe" : "device or socket"),
            "write the particles to a file first"};
    }
    size = static_cast<std::uint64_t>(info.st_size);
    if (size > kMaxFileBytes) {
        return tooLarge(name, size);
    }
    return file;
}

/// Grows with what is read: the size that a file system claims is not trusted either (/proc, a file that is still
/// being written).
Result<std::vector<std::byte>> readFile(const std::filesystem::path& path, const std::string& name) {
    std::uint64_t size = 0;
    const Result<std::unique_ptr<std::FILE, Close>> file = openFile(path, name, size);
    if (!file) {
        return file.error();
    }
    std::vector<std::byte> bytes;
    bytes.reserve(size);
    std::array<std::byte, std::size_t{64} << 10U> chunk;
    while (true) {
        errno = 0;
        const std::size_t got = std::fread(chunk.data(), 1, chunk.size(), file.value().get());
        bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(got));
        if (got < chunk.size()) {
            break;
        }
        if (bytes.size() > kMaxFileBytes) {
            return tooLarge(name, kMaxFileBytes);
        }
    }
    if (std::ferror(file.value().get()) != 0) {
        return unreadable(name, errno);
    }
    return bytes;
}

Result<ParticleSet> parse(std::span<const std::byte> bytes, Format format, const std::string& name) {
    switch (format) {
        case Format::pos:
            return parsePos(bytes, name);
        case Format::ply:
            return parsePly(bytes, name);
        case Format::bgeo:
        case Format::bgeo_gzip:
            break;
    }
    return parseBgeo(bytes, name);
}

/// Gives a set whose file holds no radius the one that the caller has for such files.
Status giveRadius(ParticleSet& set, const std::string& name, float radius, std::string_view remedy) {
    if (!usableRadius(radius)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, name,
                     radius == 0.0F
                         ? "the file holds no particle radius"
                         : fmt::format("the file holds no particle radius and the one given is {}, not from {} to {} m",
                                       radius, kMinRadius, kMaxRadius),
                     std::string(remedy)};
    }
    set.radius = radius;
    set.radius_given = true;
    return {};
}

}  // namespace

Result<ParticleSet> load(const std::filesystem::path& path, float default_radius, std::string_view radius_remedy) {
    const std::string name = path.string();
    const std::optional<Format> format = formatOf(path);
    if (!format) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, name, fmt::format("expected {}", kEndings),
                     "rename or convert the file"};
    }
    try {
        const Result<std::vector<std::byte>> bytes = readFile(path, name);
        if (!bytes) {
            return bytes.error();
        }
        Result<ParticleSet> set = parse(bytes.value(), *format, name);
        if (set && set.value().radius == 0.0F) {
            if (Status status = giveRadius(set.value(), name, default_radius, radius_remedy); !status) {
                return status.error();
            }
        }
        return set;
    } catch (const std::bad_alloc&) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, name, "there is not enough memory to read it",
                     "close other programs or split the set"};
    }
}

}  // namespace sluice::particles
