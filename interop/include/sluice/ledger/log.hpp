// SPDX-License-Identifier: MIT
// The compact append-only log: a header, then chunks; a crash leaves a readable prefix. All numbers little-endian.
//   header  16 bytes: "SLUICELG", uint32 version (2), uint32 size of an event (48)
//   chunk   16 bytes: uint32 type, uint32 bytes that follow, uint32 CRC-32 of those, uint32 CRC-32 of the 12 bytes
//                     before it (that of zlib; version 1 had neither and is not read);  then
//     1 events    n * 48 bytes of Event
//     2 actor     ActorId, uint8 ActorKind, uint8 0, name
//     3 sync      ObjectId, uint8 SyncKind, uint8 0, uint16 flags, uint64 initial, name
//     4 resource  ObjectId, uint32 layout, ActorId owner, uint16 0, name
//     5 memory    ObjectId, MemoryFacts (48 bytes)
//     6 close     empty: the log was ended on purpose
// Declarations stand before the first event that speaks of them. An unknown chunk type is skipped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "sluice/ledger/event.hpp"
#include "sluice/ledger/ledger.hpp"
#include "sluice/result.hpp"

namespace sluice::ledger {

/// Who gets the contents of a log in its order. Every member may be left empty.
struct LogSink {
    std::function<void(ActorId, ActorKind, std::string_view)> actor;
    std::function<void(ObjectId, SyncKind, std::string_view, std::uint64_t initial, std::uint16_t flags)> sync;
    std::function<void(ObjectId, std::string_view, std::uint32_t layout, ActorId owner)> resource;
    std::function<void(ObjectId, const MemoryFacts&)> memory;
    std::function<void(const Event&)> event;
};
[[nodiscard]] LogSink sinkInto(Ledger& ledger);

/// Appends to a file; may be called from any thread. Buffered: what the last flush() or a full buffer wrote survives a
/// crash. After a failed write (disk full) nothing more is written: later records are dropped and counted, and status()
/// tells that first failure and the count. Names longer than 1,024 bytes are cut.
class LogWriter {
  public:
    /// An error (SLUICE_ERROR_INTERNAL) names the path and the reason. An existing file is replaced.
    [[nodiscard]] static Result<std::unique_ptr<LogWriter>> create(const std::string& path);
    LogWriter(const LogWriter&) = delete;
    LogWriter& operator=(const LogWriter&) = delete;
    /// As close(), but nobody hears of a failure.
    ~LogWriter();

    void declareActor(ActorId id, ActorKind kind, std::string_view name);
    void declareSync(ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial, std::uint16_t flags);
    void declareResource(ObjectId id, std::string_view name, std::uint32_t layout, ActorId owner);
    void memoryFacts(ObjectId id, const MemoryFacts& facts);
    /// Fills in the sequence.
    void record(Event event);
    void flush();
    [[nodiscard]] Status status() const;
    /// Writes what is buffered and the close chunk, and closes the file: the status after that. What comes later is
    /// dropped.
    Status close();

  private:
    LogWriter();
    struct State;
    std::unique_ptr<State> state_;
};

struct LogSummary {
    std::uint64_t events = 0;
    End end = End::Truncated;
    std::uint64_t first_ns = 0, last_ns = 0;
};
/// Reads a whole log into `sink`. Errors (SLUICE_ERROR_INVALID_ARGUMENT: not a log, another version, a chunk of an
/// absurd size, a checksum that does not fit, an unknown kind, an id out of bounds, anything after the close) name the
/// file, the offset, the expected and the found; the sink may have had what stands before, and events of the damaged
/// chunk. A log that ends in the middle of a chunk is read up to there, without that chunk's checksum, and is
/// Truncated. Events get their place in the log as their sequence, whatever the file says. Bounds: actor ids below
/// 1,024 (a clock has an entry per actor), sync and resource ids below 2^24, names of at most 1,024 bytes, whose
/// control characters become '?'.
[[nodiscard]] Result<LogSummary> readLog(const std::string& path, const LogSink& sink);
/// The same from memory; `name` stands for the file in errors.
[[nodiscard]] Result<LogSummary> readLog(std::span<const std::byte> bytes, const std::string& name,
                                         const LogSink& sink);

}  // namespace sluice::ledger
