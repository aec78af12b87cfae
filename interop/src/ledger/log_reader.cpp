// SPDX-License-Identifier: MIT
// The reading half of log.hpp. A log may come from a crashed program or from a stranger: every number is judged before
// it is used, and nothing is allocated by a number of the file's.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <vector>

#include "ledger/checksum.hpp"
#include "ledger/log_bounds.hpp"
#include "ledger/log_bytes.hpp"
#include "sluice/fd.hpp"
#include "sluice/ledger/log.hpp"

namespace sluice::ledger {
namespace {

using Bytes = std::span<const std::byte>;
/// Fills `out` as far as the source reaches and returns how much; nothing after an error of the system.
using Source = std::function<std::optional<std::size_t>(std::span<std::byte> out)>;

/// Without control characters: names end up on terminals, where a stranger's escape sequences have no business.
std::string nameIn(Bytes chunk, std::size_t from) {
    const Bytes bytes = chunk.subspan(from);
    std::string name(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::ranges::replace_if(
        name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, '?');
    return name;
}

class Reader {
  public:
    Reader(std::string name, const LogSink& sink, Source source)
        : name_(std::move(name)), sink_(sink), source_(std::move(source)) {}

    Result<LogSummary> read() {
        buffer_.resize(kLogHeaderBytes);
        const std::size_t header = fill(buffer_);
        if (!failure_ && header == kLogHeaderBytes) {
            checkHeader();
        } else if (!failure_) {
            fail(0, fmt::format("expected a header of {} bytes, found {}", kLogHeaderBytes, header), kNotALog);
        }
        while (!failure_ && readChunk()) {
        }
        if (failure_) {
            return *failure_;
        }
        return summary_;
    }

  private:
    static constexpr const char* kNotALog = "give a log that Sluice or sluice_trace.h wrote";
    static constexpr const char* kDamaged = "the file is damaged here; record it anew";

    /// Keeps the first failure; the others follow from it.
    void fail(std::uint64_t offset, std::string detail, const char* remedy = kDamaged) {
        if (!failure_) {
            failure_ = Error{SLUICE_ERROR_INVALID_ARGUMENT, name_,
                             fmt::format("at byte {}: {}", offset, std::move(detail)), remedy};
        }
    }
    std::size_t fill(std::span<std::byte> out) {
        const std::optional<std::size_t> got = source_(out);
        if (!got) {
            fail(offset_, std::generic_category().message(errno), "is the file readable?");
            return 0;
        }
        offset_ += *got;
        return *got;
    }
    /// The same for the contents of a chunk, whose checksum it keeps.
    std::size_t fillBody(std::span<std::byte> out) {
        const std::size_t got = fill(out);
        body_sum_ = crc32(out.first(got), body_sum_);
        return got;
    }
    void checkHeader() {
        if (!std::equal(kLogMagic.begin(), kLogMagic.end(), reinterpret_cast<const char*>(buffer_.data()))) {
            return fail(0, "expected \"SLUICELG\", found something else", kNotALog);
        }
        const auto version = readNumber<std::uint32_t>(buffer_.data() + 8);
        if (version != kLogVersion) {
            return fail(8, fmt::format("expected version {} of the format, found {}", kLogVersion, version),
                        version < kLogVersion ? "record it anew: what an older Sluice wrote has no checksums"
                                              : "use the sluice that belongs to the program that wrote it");
        }
        const auto size = readNumber<std::uint32_t>(buffer_.data() + 12);
        if (size != sizeof(Event)) {
            fail(12, fmt::format("expected events of {} bytes, found {}", sizeof(Event), size));
        }
    }
    /// False at the end of the log.
    bool readChunk() {
        const std::uint64_t start = offset_;
        std::array<std::byte, kChunkHeaderBytes> head{};
        const std::size_t got = fill(head);
        if (summary_.end == End::Closed && got > 0) {
            fail(start, "expected the end of the file after the close, found more");
            return false;
        }
        if (got < head.size()) {
            return false;
        }
        const std::span<const std::byte> summed = std::span(head).first(kHeadSumAt);
        if (!sumFits(start, "the head of a chunk", readNumber<std::uint32_t>(head.data() + kHeadSumAt),
                     crc32(summed))) {
            return false;
        }
        const auto type = readNumber<std::uint32_t>(head.data());
        const auto size = readNumber<std::uint32_t>(head.data() + kChunkSizeAt);
        if (size > kMaxChunkBytes) {
            fail(start + kChunkSizeAt,
                 fmt::format("expected a chunk of at most {} bytes, found {}", kMaxChunkBytes, size));
            return false;
        }
        body_sum_ = 0;
        const auto wanted = readNumber<std::uint32_t>(head.data() + kBodySumAt);
        if (readBody(type, start, size)) {
            return sumFits(start + kChunkHeaderBytes, "the contents of a chunk", wanted, body_sum_);
        }
        return false;
    }
    bool sumFits(std::uint64_t offset, const char* what, std::uint32_t wanted, std::uint32_t found) {
        if (wanted != found) {
            fail(offset, fmt::format("expected {} with checksum {:08x}, found {:08x}", what, wanted, found));
        }
        return wanted == found;
    }
    /// False when the log ends in it.
    bool readBody(std::uint32_t type, std::uint64_t start, std::uint32_t size) {
        switch (static_cast<ChunkType>(type)) {
            case ChunkType::Events:
                return events(start, size);
            case ChunkType::Actor:
                return whole(start, size, kActorBytes, true) && actor(start);
            case ChunkType::Sync:
                return whole(start, size, kSyncBytes, true) && sync(start);
            case ChunkType::Resource:
                return whole(start, size, kResourceBytes, true) && resource(start);
            case ChunkType::Memory:
                return whole(start, size, kMemoryBytes, false) && memory(start);
            case ChunkType::Close:
                if (whole(start, size, 0, false)) {
                    summary_.end = End::Closed;
                }
                return !failure_;
        }
        return skip(size);  // of a later writer
    }
    /// Reads a declaration: `fixed` bytes and, where `named`, a name. False when the log ends in it.
    bool whole(std::uint64_t start, std::uint32_t size, std::size_t fixed, bool named) {
        const std::size_t most = fixed + (named ? kMaxNameBytes : 0);
        if (size < fixed || size > most) {
            fail(start + kChunkSizeAt, fmt::format("expected a chunk of {} to {} bytes, found {}", fixed, most, size));
            return false;
        }
        buffer_.resize(size);
        return fillBody(buffer_) == size && !failure_;
    }
    bool skip(std::uint32_t size) {
        buffer_.resize(std::min<std::size_t>(size, 4096));
        while (size > 0) {
            const std::size_t want = std::min<std::size_t>(size, buffer_.size());
            if (fillBody(std::span(buffer_).first(want)) != want) {
                return false;
            }
            size -= static_cast<std::uint32_t>(want);
        }
        return true;
    }
    bool within(std::uint64_t offset, const char* what, std::uint64_t id, std::uint64_t bound) {
        if (id >= bound) {
            fail(offset, fmt::format("expected {} below {}, found {}", what, bound, id));
        }
        return id < bound;
    }
    bool actor(std::uint64_t start) {
        const std::uint64_t at = start + kChunkHeaderBytes;
        const auto id = readNumber<ActorId>(buffer_.data());
        const auto kind = readNumber<std::uint8_t>(buffer_.data() + 2);
        if (!within(at, "an actor", id, kMaxActors) ||
            !within(at + 2, "a kind of actor", kind, static_cast<std::uint8_t>(ActorKind::Process) + 1U)) {
            return false;
        }
        if (sink_.actor) {
            sink_.actor(id, static_cast<ActorKind>(kind), nameIn(buffer_, kActorBytes));
        }
        return true;
    }
    bool sync(std::uint64_t start) {
        const std::uint64_t at = start + kChunkHeaderBytes;
        const auto id = readNumber<ObjectId>(buffer_.data());
        const auto kind = readNumber<std::uint8_t>(buffer_.data() + 4);
        if (!within(at, "a sync object", id, kMaxObjects) ||
            !within(at + 4, "a kind of sync object", kind, static_cast<std::uint8_t>(SyncKind::Fence) + 1U)) {
            return false;
        }
        if (sink_.sync) {
            sink_.sync(id, static_cast<SyncKind>(kind), nameIn(buffer_, kSyncBytes),
                       readNumber<std::uint64_t>(buffer_.data() + 8), readNumber<std::uint16_t>(buffer_.data() + 6));
        }
        return true;
    }
    bool resource(std::uint64_t start) {
        const auto id = readNumber<ObjectId>(buffer_.data());
        const auto owner = readNumber<ActorId>(buffer_.data() + 8);
        if (!within(start + kChunkHeaderBytes, "a resource", id, kMaxObjects) ||
            (owner != kNoActor && !within(start + kChunkHeaderBytes + 8, "an owner", owner, kMaxActors))) {
            return false;
        }
        if (sink_.resource) {
            sink_.resource(id, nameIn(buffer_, kResourceBytes), readNumber<std::uint32_t>(buffer_.data() + 4), owner);
        }
        return true;
    }
    bool memory(std::uint64_t start) {
        const auto id = readNumber<ObjectId>(buffer_.data());
        if (!within(start + kChunkHeaderBytes, "a resource", id, kMaxObjects)) {
            return false;
        }
        if (sink_.memory) {
            sink_.memory(id, readNumber<MemoryFacts>(buffer_.data() + 4));
        }
        return true;
    }
    bool events(std::uint64_t start, std::uint32_t size) {
        if (size % sizeof(Event) != 0) {
            fail(start + kChunkSizeAt,
                 fmt::format("expected a multiple of {} bytes of events, found {}", sizeof(Event), size));
            return false;
        }
        constexpr std::size_t kAtOnce = 256 * sizeof(Event);
        buffer_.resize(std::min<std::size_t>(size, kAtOnce));
        while (size > 0) {
            const std::size_t want = std::min<std::size_t>(size, buffer_.size());
            const std::uint64_t offset = offset_;
            const std::size_t got = fillBody(std::span(buffer_).first(want));
            for (std::size_t at = 0; at + sizeof(Event) <= got; at += sizeof(Event)) {
                if (!event(offset + at, buffer_.data() + at)) {
                    return false;
                }
            }
            if (got != want) {
                return false;
            }
            size -= static_cast<std::uint32_t>(want);
        }
        return true;
    }
    bool event(std::uint64_t offset, const std::byte* from) {
        // Judged as bytes, before anything takes a number for a kind.
        if (const std::optional<Outside> outside = outsideOfBounds(from)) {
            return within(offset + outside->at, outside->what, outside->found, outside->bound);
        }
        auto event = readNumber<Event>(from);
        event.sequence = summary_.events++;
        if (event.time_ns != 0) {
            summary_.first_ns = summary_.first_ns == 0 ? event.time_ns : std::min(summary_.first_ns, event.time_ns);
        }
        const std::uint64_t room = ~std::uint64_t{0} - event.time_ns;
        summary_.last_ns = std::max(summary_.last_ns, event.time_ns + std::min(event.duration_ns, room));
        if (sink_.event) {
            sink_.event(event);
        }
        return true;
    }

    std::string name_;
    const LogSink& sink_;
    Source source_;
    std::uint64_t offset_ = 0;
    std::uint32_t body_sum_ = 0;  ///< of the present chunk's contents, as far as they were read
    std::vector<std::byte> buffer_;
    LogSummary summary_;
    std::optional<Error> failure_;
};

}  // namespace

Result<LogSummary> readLog(Bytes bytes, const std::string& name, const LogSink& sink) {
    return Reader(name, sink,
                  [bytes](std::span<std::byte> out) mutable -> std::optional<std::size_t> {
                      const std::size_t take = std::min(out.size(), bytes.size());
                      std::copy_n(bytes.begin(), take, out.begin());
                      bytes = bytes.subspan(take);
                      return take;
                  })
        .read();
}

Result<LogSummary> readLog(const std::string& path, const LogSink& sink) {
    const UniqueFd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat facts {};
    if (!file.valid() || ::fstat(file.get(), &facts) != 0) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path,
                     fmt::format("cannot be opened: {}", std::generic_category().message(errno)),
                     "give the path of a ledger log"};
    }
    if (S_ISDIR(facts.st_mode)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path, "is a folder", "give the path of a ledger log"};
    }
    return Reader(path, sink,
                  [&file](std::span<std::byte> out) -> std::optional<std::size_t> {
                      std::size_t got = 0;
                      while (got < out.size()) {
                          const ssize_t step = ::read(file.get(), out.data() + got, out.size() - got);
                          if (step < 0 && errno == EINTR) {
                              continue;
                          }
                          if (step < 0) {
                              return std::nullopt;
                          }
                          if (step == 0) {
                              break;
                          }
                          got += static_cast<std::size_t>(step);
                      }
                      return got;
                  })
        .read();
}

}  // namespace sluice::ledger
