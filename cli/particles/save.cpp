// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "bytes.hpp"
#include "encode.hpp"
#include "ending.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::particles {

namespace {

Error unwritable(const std::string& name, int code) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name,
            fmt::format("cannot be written: {}", std::generic_category().message(code)),
            "check that the folder exists, may be written and has room"};
}

/// A file under a name of its own that is removed again unless it is renamed.
class TemporaryFile {
  public:
    explicit TemporaryFile(std::filesystem::path target) : path_(std::move(target)) {
        static std::atomic<unsigned> number{0};
        path_ += fmt::format(".tmp-{}-{}", getpid(), number.fetch_add(1));
        fd_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    TemporaryFile(TemporaryFile&&) = delete;
    TemporaryFile& operator=(TemporaryFile&&) = delete;
    ~TemporaryFile() {
        if (fd_ >= 0) {
            close(fd_);
        }
        if (created_ && !path_.empty()) {
            unlink(path_.c_str());
        }
    }

    [[nodiscard]] bool write(Bytes bytes) {
        created_ = fd_ >= 0;
        while (created_ && !bytes.empty()) {
            const ssize_t done = ::write(fd_, bytes.data(), bytes.size());
            if (done < 0 && errno == EINTR) {
                continue;
            }
            if (done < 0) {
                return false;
            }
            bytes = bytes.subspan(static_cast<std::size_t>(done));
        }
        return created_;
    }

    /// The bytes reach the disk before the name does, so that a crash leaves the old file or the new one.
    [[nodiscard]] bool becomeTarget(const std::filesystem::path& target) {
        if (fsync(fd_) != 0 || close(std::exchange(fd_, -1)) != 0 || std::rename(path_.c_str(), target.c_str()) != 0) {
            return false;
        }
        created_ = false;
        return true;
    }

  private:
    std::filesystem::path path_;
    int fd_ = -1;
    bool created_ = false;
};

}  // namespace

Status checkEnding(const std::filesystem::path& path) {
    if (!formatOf(path)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(), fmt::format("expected {}", kEndings),
                     "choose one of these"};
    }
    return {};
}

Status save(const std::filesystem::path& path, const ParticleSet& set) {
    if (Status status = checkEnding(path); !status) {
        return status;
    }
    const std::string name = path.string();
    const std::optional<Format> format = formatOf(path);
    try {
        const Result<std::vector<std::byte>> bytes = encode(set, *format, name);
        if (!bytes) {
            return bytes.error();
        }
        TemporaryFile file(path);
        if (!file.write(bytes.value()) || !file.becomeTarget(path)) {
            return unwritable(name, errno);
        }
        return {};
    } catch (const std::bad_alloc&) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, name, "there is not enough memory to write it",
                     "close other programs"};
    }
}

}  // namespace sluice::particles
