// SPDX-License-Identifier: MIT
// gzip (RFC 1952) to and from memory, with a bound on what may come out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "sluice/result.hpp"

namespace sluice::particles {

[[nodiscard]] bool looksLikeGzip(Bytes bytes);

/// The most that `compressed_size` bytes may inflate to. Deflate can reach 1032:1, but only on constant data; floats of
/// real particles stay below 10:1, with constant attributes below 30:1. So 100:1, with 1 MiB to start with, and never
/// more than 64 bytes for each of kMaxParticles.
[[nodiscard]] std::uint64_t inflateLimit(std::uint64_t compressed_size);

/// Inflates every member of `bytes`. Memory grows with what comes out, up to `limit`; more is an error, as are a
/// damaged stream, a wrong checksum, a cut end and bytes that follow.
[[nodiscard]] Result<std::vector<std::byte>> inflateGzip(Bytes bytes, const std::string& name, std::uint64_t limit);

[[nodiscard]] Result<std::vector<std::byte>> deflateGzip(Bytes bytes, const std::string& name);

}  // namespace sluice::particles
