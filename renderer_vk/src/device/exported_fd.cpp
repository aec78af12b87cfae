// SPDX-License-Identifier: MIT
#include "device/exported_fd.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <string>

#include "device/device.hpp"

namespace sluice::vk {

Result<UniqueFd> exportedFd(VkResult result, int fd, std::string_view call) {
    if (result != VK_SUCCESS && result != VK_ERROR_TOO_MANY_OBJECTS) {
        return vulkanError(result, call);
    }
    if (result == VK_SUCCESS && fd >= 0) {
        return UniqueFd(fd);
    }
    // TOO_MANY_OBJECTS by the specification; Mesa returns success and -1 when dup fails.
    rlimit limit{};
    const bool known = ::getrlimit(RLIMIT_NOFILE, &limit) == 0;
    return Error{SLUICE_ERROR_OUT_OF_MEMORY, std::string(call),
                 fmt::format("the driver gave descriptor {}; this process may have {} open", fd,
                             known ? std::to_string(limit.rlim_cur) : "an unknown number of them"),
                 "raise the limit of open files with `ulimit -n`, or use fewer image sets"};
}

}  // namespace sluice::vk
