// SPDX-License-Identifier: MIT
// Descriptors that nothing mistakes for a standard stream.
#pragma once

#include <fcntl.h>

#include <utility>

#include "sluice/fd.hpp"

namespace sluice::isolate {

/// `fd` under a number from 3 on, close-on-exec; empty, with errno, when the process is out of descriptors. Where a
/// process has closed its standard streams, a new descriptor gets one of their numbers, and whatever prints to standard
/// error, a driver for one, would write into it.
[[nodiscard]] inline UniqueFd aboveStreams(UniqueFd fd) {
    return !fd.valid() || fd.get() > 2 ? std::move(fd) : UniqueFd(::fcntl(fd.get(), F_DUPFD_CLOEXEC, 3));
}

}  // namespace sluice::isolate
