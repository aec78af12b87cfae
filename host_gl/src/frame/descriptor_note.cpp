// SPDX-License-Identifier: MIT
#include "frame/descriptor_note.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace sluice::host {

namespace {

// A start with two image sets was seen to need 11 (the property that Scarcity.AStart... records); drivers differ.
constexpr rlim_t kFew = 64;
// Nobody with so many numbers to give is out of them because of this process's first ones.
constexpr rlim_t kMostLookedAt = 65536;

}  // namespace

Status withDescriptorNote(Status status) {
    rlimit limit{};
    if (status || getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur > kMostLookedAt) {
        return status;
    }
    rlim_t free = 0;
    // Counted without opening anything.
    for (rlim_t number = 0; number < limit.rlim_cur && free < kFew; ++number) {
        free += fcntl(static_cast<int>(number), F_GETFD) < 0 ? 1U : 0U;
    }
    if (free >= kFew) {
        return status;
    }
    Error error = status.error();
    error.detail += fmt::format(", while of {} file descriptors {} are free", limit.rlim_cur, free);
    error.remedy = "close some, or raise the limit with ulimit -n";
    return error;
}

}  // namespace sluice::host
