// SPDX-License-Identifier: MIT
// The numbers of log.hpp's format that writer and reader share.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "sluice/ledger/event.hpp"

namespace sluice::ledger {

static_assert(std::endian::native == std::endian::little, "events go to the file as they lie in memory");

constexpr std::array<char, 8> kLogMagic{'S', 'L', 'U', 'I', 'C', 'E', 'L', 'G'};
constexpr std::uint32_t kLogVersion = 2;
constexpr std::size_t kLogHeaderBytes = 16, kChunkHeaderBytes = 16;
/// In a chunk's head: where its size, the checksum of its contents and that of the head itself stand.
constexpr std::size_t kChunkSizeAt = 4, kBodySumAt = 8, kHeadSumAt = 12;

enum class ChunkType : std::uint32_t { Events = 1, Actor, Sync, Resource, Memory, Close };

/// Bytes of a declaration before its name, and of the facts of a memory.
constexpr std::size_t kActorBytes = 4, kSyncBytes = 16, kResourceBytes = 12, kMemoryBytes = 52;
/// The writer cuts longer names; the reader takes a longer one for damage.
constexpr std::size_t kMaxNameBytes = 1024;
/// A cut chunk has no checksum to hold it to, so those of events end after a few.
constexpr std::size_t kMostEventBytes = 256 * sizeof(Event);
/// Far above what the writer makes (64 KiB). A larger size in a file is damage, not data.
constexpr std::uint32_t kMaxChunkBytes = 16U << 20U;
/// Bounds of ids in a file. A clock has an entry per actor, so their number decides what memory a log can ask for.
constexpr std::uint32_t kMaxActors = 1024;
constexpr std::uint32_t kMaxObjects = 1U << 24U;

template <typename T>
[[nodiscard]] T readNumber(const std::byte* at) {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, at, sizeof(T));
    return value;
}

}  // namespace sluice::ledger
