// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "sluice/isolate/messages.hpp"
#include "targets.hpp"

namespace sluice::fuzz {

namespace {

void require(bool condition, const char* promise) {
    if (!condition) {
        std::fprintf(stderr, "broken promise: %s\n", promise);
        std::abort();
    }
}

}  // namespace

void isolate(std::span<const std::byte> bytes) {
    for (const std::uint32_t fds : {0U, 1U}) {
        const Result<isolate::Decoded> decoded = isolate::decode(bytes, fds);
        if (!decoded) {
            require(decoded.error().code == SLUICE_ERROR_INVALID_ARGUMENT, "a bad message is an invalid argument");
            require(decoded.error().message().find("expected ") != std::string::npos,
                    "an error says what was expected");
            require(decoded.error().message().size() < 400, "a message is short, whatever came");
            continue;
        }
        const std::vector<std::byte> again = isolate::encode(decoded.value().message, decoded.value().call, fds);
        require(again.size() <= isolate::kMaxMessage, "what was read fits into a message");
        const Result<isolate::Decoded> back = isolate::decode(again, fds);
        require(back.ok(), "what was written can be read");
        require(isolate::encode(back.value().message, back.value().call, fds) == again,
                "a message survives writing and reading");
    }
}

}  // namespace sluice::fuzz
