// SPDX-License-Identifier: MIT
// The writing half of log.hpp. No fmt here: sluice_trace is linked into engines that do not have it.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <optional>
#include <span>
#include <system_error>
#include <vector>

#include "ledger/checksum.hpp"
#include "ledger/log_bytes.hpp"
#include "sluice/fd.hpp"
#include "sluice/ledger/log.hpp"

namespace sluice::ledger {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{64} * 1024;

Error fault(const std::string& path, const char* step, int code) {
    return {SLUICE_ERROR_INTERNAL, "ledger log '" + path + "'",
            std::string(step) + ": " + std::generic_category().message(code) + " (errno " + std::to_string(code) + ")",
            "give a path in a writable folder with room on its disk"};
}

/// At most kMaxNameBytes, cut between two characters of UTF-8.
std::string_view bounded(std::string_view name) {
    if (name.size() <= kMaxNameBytes) {
        return name;
    }
    std::size_t end = kMaxNameBytes;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) {
        --end;
    }
    return name.substr(0, end);
}

}  // namespace

struct LogWriter::State {
    mutable std::mutex mutex;
    std::string path;
    UniqueFd file;
    std::vector<std::byte> buffer;    ///< reserved once: record() allocates nothing
    std::optional<std::size_t> last;  ///< where the chunk at the buffer's end begins: its sizes and sums are missing
    bool takes_events = false;        ///< and that is one of events
    std::uint64_t sequence = 0;
    std::uint64_t dropped = 0;
    int failed = 0;  ///< errno of the write that failed

    /// Fills in the head of the last chunk.
    void seal() {
        if (!last) {
            return;
        }
        const std::span<std::byte> chunk = std::span(buffer).subspan(*last);
        const std::span<const std::byte> body = chunk.subspan(kChunkHeaderBytes);
        const auto fill = [&chunk](std::size_t at, std::uint32_t number) {
            std::memcpy(chunk.subspan(at).data(), &number, sizeof(number));
        };
        fill(kChunkSizeAt, static_cast<std::uint32_t>(body.size()));
        fill(kBodySumAt, crc32(body));
        fill(kHeadSumAt, crc32(chunk.first(kHeadSumAt)));
        last.reset();
        takes_events = false;
    }
    void writeOut() {
        seal();
        const std::byte* at = buffer.data();
        std::size_t left = failed == 0 ? buffer.size() : 0;
        while (left > 0) {
            const ssize_t written = ::write(file.get(), at, left);
            if (written < 0 && errno == EINTR) {
                continue;
            }
            if (written <= 0) {
                failed = written < 0 ? errno : EIO;
                break;
            }
            at += written;
            left -= static_cast<std::size_t>(written);
        }
        buffer.clear();
    }
    /// Makes room; false when the log is closed, and false, and counted, when it has failed before.
    bool room(std::size_t bytes) {
        if (!file.valid()) {
            return false;
        }
        if (failed == 0 && buffer.size() + bytes > kBufferBytes) {
            writeOut();
        }
        if (failed != 0) {
            ++dropped;
        }
        return failed == 0;
    }
    void end() {
        if (!file.valid()) {
            return;
        }
        writeOut();
        // Not after a failure: the last chunk may be cut, and the log did not end as it was meant to.
        if (failed == 0) {
            chunk(ChunkType::Close);
            writeOut();
        }
        // Some file systems tell only here that there was no room.
        if (::close(file.release()) != 0 && failed == 0) {
            failed = errno;
        }
    }
    [[nodiscard]] Status told() const {
        if (failed == 0) {
            return {};
        }
        Error error = fault(path, "cannot write it", failed);
        error.detail += "; " + std::to_string(dropped) + " records dropped since";
        return error;
    }
    void append(const void* from, std::size_t bytes) {
        const auto* first = static_cast<const std::byte*>(from);
        buffer.insert(buffer.end(), first, first + bytes);
    }
    template <typename T>
    void put(T value) {
        append(&value, sizeof(value));
    }
    void chunk(ChunkType type) {
        seal();
        last = buffer.size();
        takes_events = type == ChunkType::Events;
        put(static_cast<std::uint32_t>(type));
        buffer.resize(*last + kChunkHeaderBytes);
    }
    /// The same for a chunk that has its own head and `bytes` at once; false as room() is.
    bool begin(ChunkType type, std::size_t bytes) {
        const bool fits = room(kChunkHeaderBytes + bytes);
        if (fits) {
            chunk(type);
        }
        return fits;
    }
};

LogWriter::LogWriter() : state_(std::make_unique<State>()) {}

Result<std::unique_ptr<LogWriter>> LogWriter::create(const std::string& path) {
    std::unique_ptr<LogWriter> writer(new LogWriter);
    State& s = *writer->state_;
    s.path = path;
    s.buffer.reserve(kBufferBytes);
    s.file = UniqueFd(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!s.file.valid()) {
        return fault(path, "cannot create it", errno);
    }
    s.append(kLogMagic.data(), kLogMagic.size());
    s.put(kLogVersion);
    s.put(static_cast<std::uint32_t>(sizeof(Event)));
    s.writeOut();
    if (s.failed != 0) {
        return fault(path, "cannot write its header", s.failed);
    }
    return writer;
}

LogWriter::~LogWriter() {
    const std::scoped_lock lock(state_->mutex);
    state_->end();
}

Status LogWriter::close() {
    const std::scoped_lock lock(state_->mutex);
    state_->end();
    return state_->told();
}

void LogWriter::declareActor(ActorId id, ActorKind kind, std::string_view name) {
    name = bounded(name);
    const std::scoped_lock lock(state_->mutex);
    if (!state_->begin(ChunkType::Actor, kActorBytes + name.size())) {
        return;
    }
    state_->put(id);
    state_->put(kind);
    state_->put(std::uint8_t{0});
    state_->append(name.data(), name.size());
}

void LogWriter::declareSync(ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial,
                            std::uint16_t flags) {
    name = bounded(name);
    const std::scoped_lock lock(state_->mutex);
    if (!state_->begin(ChunkType::Sync, kSyncBytes + name.size())) {
        return;
    }
    state_->put(id);
    state_->put(kind);
    state_->put(std::uint8_t{0});
    state_->put(flags);
    state_->put(initial);
    state_->append(name.data(), name.size());
}

void LogWriter::declareResource(ObjectId id, std::string_view name, std::uint32_t layout, ActorId owner) {
    name = bounded(name);
    const std::scoped_lock lock(state_->mutex);
    if (!state_->begin(ChunkType::Resource, kResourceBytes + name.size())) {
        return;
    }
    state_->put(id);
    state_->put(layout);
    state_->put(owner);
    state_->put(std::uint16_t{0});
    state_->append(name.data(), name.size());
}

void LogWriter::memoryFacts(ObjectId id, const MemoryFacts& facts) {
    static_assert(sizeof(MemoryFacts) == kMemoryBytes - sizeof(ObjectId));
    const std::scoped_lock lock(state_->mutex);
    if (!state_->begin(ChunkType::Memory, kMemoryBytes)) {
        return;
    }
    state_->put(id);
    state_->put(facts);
}

void LogWriter::record(Event event) {
    const std::scoped_lock lock(state_->mutex);
    if (!state_->room(kChunkHeaderBytes + sizeof(Event))) {
        return;
    }
    if (!state_->takes_events || state_->buffer.size() - *state_->last >= kChunkHeaderBytes + kMostEventBytes) {
        state_->chunk(ChunkType::Events);
    }
    event.sequence = state_->sequence++;
    state_->put(event);
}

void LogWriter::flush() {
    const std::scoped_lock lock(state_->mutex);
    if (state_->file.valid()) {
        state_->writeOut();
    }
}

Status LogWriter::status() const {
    const std::scoped_lock lock(state_->mutex);
    return state_->told();
}

}  // namespace sluice::ledger
