// SPDX-License-Identifier: MIT
// What each fuzz target does with bytes. A broken promise aborts: libFuzzer and the replay test both see that.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace sluice::fuzz {

using Target = void (*)(std::span<const std::byte>);

void pos(std::span<const std::byte> bytes);
void ply(std::span<const std::byte> bytes);
void bgeo(std::span<const std::byte> bytes);
void scene(std::span<const std::byte> bytes);
/// Reads a log, judges it with the ledger, and computes and draws nothing that it could not hold.
void ledger_log(std::span<const std::byte> bytes);

/// A message between the processes of an isolated renderer.
void isolate(std::span<const std::byte> bytes);

/// Does what a target does when a promise is broken; for the test of the replay itself.
[[noreturn]] void breakPromise();

/// The target of that name; null for an unknown one.
[[nodiscard]] Target targetNamed(std::string_view name);

}  // namespace sluice::fuzz
