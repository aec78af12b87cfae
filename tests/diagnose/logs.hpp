// SPDX-License-Identifier: MIT
// Logs of a small engine, for the tests of `sluice diagnose`.
#pragma once

#include <cstdint>
#include <string>

namespace sluice::test {

enum class Seeded {
    Nothing,      ///< clean
    MissingWait,  ///< the queue reads in every frame without waiting for the write
    DeadWait,     ///< the queue waits for what the GL context ended without signalling
};
/// Frames of three actors: a thread that feeds gl and queue, gl draws, the queue waits, reads and signals, the thread
/// waits for it 150 us. A frame takes 1 ms and begins at 1 ms times its number, so that everything can be computed.
void writeEngineLog(const std::string& path, std::uint32_t frames, Seeded seeded);

}  // namespace sluice::test
