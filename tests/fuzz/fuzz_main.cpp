// SPDX-License-Identifier: MIT
// libFuzzer's entry; SLUICE_FUZZ_TARGET is the function of targets.hpp that this program drives.
#include <cstddef>
#include <cstdint>
#include <span>

#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    sluice::fuzz::SLUICE_FUZZ_TARGET(std::as_bytes(std::span(data, size)));
    return 0;
}
