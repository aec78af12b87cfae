// SPDX-License-Identifier: MIT
// A file descriptor that closes itself.
#pragma once

#include <utility>

namespace sluice {

/// Owns one file descriptor. Move-only; -1 is empty.
/// Export: the API that made the fd gives it to a UniqueFd. Import: pass get() to the call and release() only after the
/// call is known to have succeeded, because on failure the fd is still ours.
class UniqueFd {
  public:
    UniqueFd() = default;
    explicit UniqueFd(int fd) : fd_(fd) {}
    UniqueFd(UniqueFd&& other) noexcept : fd_(other.release()) {}
    UniqueFd& operator=(UniqueFd&& other) noexcept {
        reset(other.release());
        return *this;
    }
    UniqueFd(const UniqueFd&) = delete;
    UniqueFd& operator=(const UniqueFd&) = delete;
    ~UniqueFd() { reset(); }

    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] bool valid() const { return fd_ >= 0; }
    /// Gives the descriptor up without closing it.
    [[nodiscard]] int release() { return std::exchange(fd_, -1); }
    /// Closes what is held, if anything, and takes `fd`. Taking what is already held is a broken contract.
    void reset(int fd = -1);
    /// A second descriptor of the same file (close-on-exec), empty if the process is out of descriptors.
    [[nodiscard]] UniqueFd duplicate() const;

  private:
    int fd_ = -1;
};

}  // namespace sluice
