// SPDX-License-Identifier: MIT
#include "gzip.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "failure.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::particles {

namespace {

constexpr int kGzipOnly = 15 + 16;  // zlib: largest window, gzip wrapper
constexpr std::size_t kChunk = std::size_t{64} << 10U;

/// zlib's stream, ended with its owner.
struct Inflater {
    z_stream stream{};
    bool ready = inflateInit2(&stream, kGzipOnly) == Z_OK;
    Inflater() = default;
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    Inflater(Inflater&&) = delete;
    Inflater& operator=(Inflater&&) = delete;
    ~Inflater() {
        if (ready) {
            inflateEnd(&stream);
        }
    }
};

struct Deflater {
    z_stream stream{};
    bool ready = deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipOnly, 8, Z_DEFAULT_STRATEGY) == Z_OK;
    Deflater() = default;
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;
    Deflater(Deflater&&) = delete;
    Deflater& operator=(Deflater&&) = delete;
    ~Deflater() {
        if (ready) {
            deflateEnd(&stream);
        }
    }
};

Error outOfMemory(const std::string& name) {
    return {SLUICE_ERROR_OUT_OF_MEMORY, name, "zlib has no memory for its window", "close other programs"};
}

/// zlib counts in 32 bits and reads through a pointer to non-const that it does not write to.
void feed(z_stream& stream, Bytes bytes, std::size_t at) {
    stream.next_in = const_cast<Bytef*>(static_cast<const Bytef*>(static_cast<const void*>(bytes.data() + at)));
    stream.avail_in = static_cast<uInt>(std::min<std::size_t>(bytes.size() - at, std::numeric_limits<uInt>::max()));
}

}  // namespace

bool looksLikeGzip(Bytes bytes) {
    return bytes.size() >= 2 && bytes[0] == std::byte{0x1F} && bytes[1] == std::byte{0x8B};
}

std::uint64_t inflateLimit(std::uint64_t compressed_size) {
    constexpr std::uint64_t kRatio = 100;
    constexpr std::uint64_t kStart = std::uint64_t{1} << 20U;
    constexpr std::uint64_t kCeiling = kMaxParticles * 64;
    return compressed_size > (kCeiling - kStart) / kRatio ? kCeiling : compressed_size * kRatio + kStart;
}

Result<std::vector<std::byte>> inflateGzip(Bytes bytes, const std::string& name, std::uint64_t limit) {
    Inflater inflater;
    if (!inflater.ready) {
        return outOfMemory(name);
    }
    z_stream& stream = inflater.stream;
    std::vector<std::byte> out;
    std::array<std::byte, kChunk> chunk;
    for (std::size_t at = 0;;) {
        feed(stream, bytes, at);
        stream.next_out = static_cast<Bytef*>(static_cast<void*>(chunk.data()));
        stream.avail_out = static_cast<uInt>(chunk.size());
        const uInt offered = stream.avail_in;
        const int status = inflate(&stream, Z_NO_FLUSH);
        at += offered - stream.avail_in;
        const std::size_t made = chunk.size() - stream.avail_out;
        if (made > limit - out.size()) {
            return failure(
                name, atByte(at), fmt::format("at most {} bytes of inflated data", limit), "more",
                "nothing that holds particles packs this tightly; if it is sound, decompress it with gunzip first");
        }
        out.insert(out.end(), chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(made));
        if (status == Z_MEM_ERROR) {
            return outOfMemory(name);
        }
        if (status == Z_STREAM_END) {
            if (at == bytes.size()) {
                return out;
            }
            if (!looksLikeGzip(bytes.subspan(at))) {
                return failure(name, atByte(at), "the end of the file after the gzip data",
                               fmt::format("{} more bytes", bytes.size() - at));
            }
            inflateReset(&stream);
        } else if (status != Z_OK && status != Z_BUF_ERROR) {
            return failure(name, atByte(at), "sound gzip data", stream.msg != nullptr ? stream.msg : "a damaged stream",
                           "the file is damaged; write it again");
        } else if (at == bytes.size() && stream.avail_out != 0) {
            return failure(name, atByte(at), "more gzip data", "the end of the file", "the file is cut short");
        }
    }
}

Result<std::vector<std::byte>> deflateGzip(Bytes bytes, const std::string& name) {
    Deflater deflater;
    if (!deflater.ready) {
        return outOfMemory(name);
    }
    z_stream& stream = deflater.stream;
    std::vector<std::byte> out;
    std::array<std::byte, kChunk> chunk;
    for (std::size_t at = 0;;) {
        feed(stream, bytes, at);
        stream.next_out = static_cast<Bytef*>(static_cast<void*>(chunk.data()));
        stream.avail_out = static_cast<uInt>(chunk.size());
        const uInt offered = stream.avail_in;
        const int status = deflate(&stream, bytes.size() - at == offered ? Z_FINISH : Z_NO_FLUSH);
        at += offered - stream.avail_in;
        out.insert(out.end(), chunk.begin(), chunk.end() - static_cast<std::ptrdiff_t>(stream.avail_out));
        if (status == Z_STREAM_END) {
            return out;
        }
        if (status != Z_OK && status != Z_BUF_ERROR) {
            return Error{SLUICE_ERROR_INTERNAL, name, fmt::format("zlib failed with status {}", status), ""};
        }
    }
}

}  // namespace sluice::particles
