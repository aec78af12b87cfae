// SPDX-License-Identifier: MIT
// What the functions of an isolated renderer and those of an isolated plugin have in common.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "isolate/renderer_process.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/isolate/messages.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host::proxy {

/// What a SluiceRenderer* of these functions points to.
struct Proxy {
    std::unique_ptr<RendererProcess> process;
    SluiceHostServices services{};
    bool by_cpu = false;              ///< the host's counter is signalled by timeline_signal
    std::uint64_t frame = 0;          ///< submitted last
    std::uint32_t max_particles = 0;  ///< that the device takes; 0: not said
};

[[nodiscard]] inline Proxy* of(SluiceRenderer* renderer) {
    return reinterpret_cast<Proxy*>(renderer);
}

[[nodiscard]] inline Error isNull(const char* name) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name, "it is NULL", ""};
}

/// What the other side returned, as a Status.
[[nodiscard]] inline Status statusOf(const isolate::Returned& returned) {
    if (returned.result == SLUICE_OK) {
        return {};
    }
    return Error{static_cast<SluiceResult>(returned.result), {}, returned.message, {}};
}

/// A call whose answer is its result alone.
[[nodiscard]] inline Status simply(RendererProcess& process, const isolate::Message& message, std::string doing,
                                   const CallBacks& back, std::span<const int> fds = {}) {
    Result<Reply> reply = process.call(message, fds, std::move(doing), back);
    return reply ? statusOf(reply.value().returned) : Status{reply.error()};
}

template <typename T>
[[nodiscard]] Status filledBy(const isolate::Returned& returned, T* to, const char* name) {
    if (Status status = statusOf(returned); !status) {
        return status;
    }
    const T* found = std::get_if<T>(&returned.filled);
    if (found == nullptr) {
        return Error{SLUICE_ERROR_INTERNAL, name, "the renderer process filled something else",
                     "use host and renderer of one release"};
    }
    return writeAbiStruct(to, *found, name);
}

}  // namespace sluice::host::proxy
