// SPDX-License-Identifier: MIT
#include "sluice/fd.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cassert>

namespace sluice {

void UniqueFd::reset(int fd) {
    assert(fd < 0 || fd != fd_);
    // EINTR is not retried: on Linux the descriptor is gone by then, and a retry could close one that another thread
    // has just been given (close(2), "Dealing with error returns").
    if (fd_ >= 0) {
        ::close(fd_);
    }
    fd_ = fd;
}

UniqueFd UniqueFd::duplicate() const {
    return fd_ < 0 ? UniqueFd() : UniqueFd(::fcntl(fd_, F_DUPFD_CLOEXEC, 0));
}

}  // namespace sluice
