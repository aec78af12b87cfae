// SPDX-License-Identifier: MIT
#include "sluice/isolate/sealed_memory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "sluice/isolate/above_streams.hpp"

namespace sluice::isolate {

namespace {

constexpr const char* kThing = "shared memory";
constexpr int kFixedSize = F_SEAL_SHRINK | F_SEAL_GROW;

Error systemError(const char* call, std::size_t size) {
    const int number = errno;
    return {number == ENOMEM || number == ENOSPC ? SLUICE_ERROR_OUT_OF_MEMORY : SLUICE_ERROR_INTERNAL, kThing,
            fmt::format("{} of {} bytes: {}", call, size, std::strerror(number)), ""};
}

Result<UniqueFd> makeFile(std::size_t size) {
    UniqueFd fd = aboveStreams(UniqueFd(::memfd_create("sluice", MFD_CLOEXEC | MFD_ALLOW_SEALING)));
    if (!fd.valid() || ::ftruncate(fd.get(), static_cast<off_t>(size)) != 0) {
        return systemError("memfd_create", size);
    }
    return fd;
}

Status writeAll(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) {
            return systemError("write", bytes.size());
        }
        bytes = bytes.subspan(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
    return {};
}

Result<Mapping> map(const UniqueFd& fd, std::size_t size, int protection, int seals) {
    struct stat found {};
    if (::fstat(fd.get(), &found) != 0) {
        return systemError("fstat", size);
    }
    if (found.st_size < 0 || static_cast<std::size_t>(found.st_size) != size || size == 0) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, kThing,
                     fmt::format("expected {} bytes, found {}", size, found.st_size), ""};
    }
    const int held = ::fcntl(fd.get(), F_GET_SEALS);
    if (held < 0 || (held & seals) != seals) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, kThing,
                     fmt::format("expected seals {:#x}, found {:#x}: its size or contents could still change", seals,
                                 held < 0 ? 0 : held),
                     ""};
    }
    void* at = ::mmap(nullptr, size, protection, MAP_SHARED, fd.get(), 0);
    if (at == MAP_FAILED) {
        return systemError("mmap", size);
    }
    return Mapping(at, size);
}

}  // namespace

Mapping::Mapping(Mapping&& other) noexcept
    : at_(std::exchange(other.at_, nullptr)), size_(std::exchange(other.size_, 0)) {}

Mapping& Mapping::operator=(Mapping&& other) noexcept {
    std::swap(at_, other.at_);
    std::swap(size_, other.size_);
    return *this;
}

Mapping::~Mapping() {
    if (at_ != nullptr) {
        ::munmap(at_, size_);
    }
}

Result<UniqueFd> sealedCopy(std::span<const std::span<const std::byte>> parts) {
    Result<UniqueFd> file = makeFile(0);
    if (!file) {
        return file;
    }
    std::size_t size = 0;
    for (const std::span<const std::byte> part : parts) {
        if (Status status = writeAll(file.value().get(), part); !status) {
            return status.error();
        }
        size += part.size();
    }
    if (::fcntl(file.value().get(), F_ADD_SEALS, kFixedSize | F_SEAL_WRITE | F_SEAL_SEAL) != 0) {
        return systemError("sealing", size);
    }
    return file;
}

Result<Mapping> mapSealed(const UniqueFd& fd, std::size_t size) {
    return map(fd, size, PROT_READ, kFixedSize | F_SEAL_WRITE);
}

Result<UniqueFd> sharedPage(std::size_t size) {
    Result<UniqueFd> file = makeFile(size);
    if (file && ::fcntl(file.value().get(), F_ADD_SEALS, kFixedSize | F_SEAL_SEAL) != 0) {
        return systemError("sealing", size);
    }
    return file;
}

Result<Mapping> mapShared(const UniqueFd& fd, std::size_t size) {
    return map(fd, size, PROT_READ | PROT_WRITE, kFixedSize);
}

}  // namespace sluice::isolate
