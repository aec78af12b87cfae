// SPDX-License-Identifier: MIT
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

/// Grows with what is read: the size that a file system claims is not trusted either (pipes, /proc).
Result<std::vector<std::byte>> readFile(const std::filesystem::path& path, const std::string& name) {
    const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    if (!file) {
        return unreadable(name, errno);
    }
    std::vector<std::byte> bytes;
    std::error_code ignored;
    if (const auto size = std::filesystem::file_size(path, ignored); !ignored) {
        bytes.reserve(size);
    }
    std::array<std::byte, std::size_t{64} << 10U> chunk;
    while (true) {
        errno = 0;
        const std::size_t got = std::fread(chunk.data(), 1, chunk.size(), file.get());
        bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(got));
        if (got < chunk.size()) {
            break;
        }
    }
    if (std::ferror(file.get()) != 0) {
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

}  // namespace

Result<ParticleSet> load(const std::filesystem::path& path, float default_radius) {
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
            if (!usableRadius(default_radius)) {
                return Error{SLUICE_ERROR_INVALID_ARGUMENT, name,
                             fmt::format("the file holds no particle radius and the one given is {}", default_radius),
                             "give the radius in metres in the scene or on the command line"};
            }
            set.value().radius = default_radius;
        }
        return set;
    } catch (const std::bad_alloc&) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, name, "there is not enough memory to read it",
                     "close other programs or split the set"};
    }
}

}  // namespace sluice::particles
