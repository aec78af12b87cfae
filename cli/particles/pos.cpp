// SPDX-License-Identifier: MIT
// .pos: u32 count, f32 radius, count x 3 f32; little-endian. The layout of the narrow-range filter's public data sets.
#include <fmt/format.h>

#include "builder.hpp"
#include "bytes.hpp"

namespace sluice::particles {

Result<ParticleSet> parsePos(std::span<const std::byte> bytes, const std::string& name) {
    constexpr std::size_t kHeader = 8;
    constexpr std::size_t kStride = 12;
    if (bytes.size() < kHeader) {
        return failure(name, atByte(bytes.size()), "a header of 8 bytes (u32 count, f32 radius)",
                       fmt::format("a file of {} bytes", bytes.size()),
                       "the file is empty or cut short; write it again");
    }
    const auto count = readLittle<std::uint32_t>(bytes.data());
    if (const Status ok = checkCount(name, count, atByte(0)); !ok) {
        return ok.error();
    }
    Builder builder(name);
    if (const Status ok = builder.setRadius(readLittle<float>(bytes.data() + 4), atByte(4)); !ok) {
        return ok.error();
    }
    const std::uint64_t expected = kHeader + std::uint64_t{count} * kStride;
    if (bytes.size() != expected) {
        return failure(name, atByte(std::min<std::uint64_t>(bytes.size(), expected)),
                       fmt::format("{} bytes for {} particles", expected, count), fmt::format("{} bytes", bytes.size()),
                       bytes.size() < expected
                           ? "the file is cut short; write it again"
                           : "there are bytes after the last particle; this is no .pos file, or two joined");
    }
    builder.reserve(count, false, false);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = kHeader + i * kStride;
        const std::byte* from = bytes.data() + at;
        const Triple position{readLittle<float>(from), readLittle<float>(from + 4), readLittle<float>(from + 8)};
        if (const Status ok = builder.addPosition(position, atByte(at)); !ok) {
            return ok.error();
        }
    }
    return builder.finish();
}

}  // namespace sluice::particles
