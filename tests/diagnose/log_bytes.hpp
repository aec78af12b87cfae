// SPDX-License-Identifier: MIT
// Small logs, and their bytes.
#pragma once

#include <sys/resource.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sluice/ledger/log.hpp"

namespace sluice::test {

using Bytes = std::vector<std::byte>;

/// A file of the test's own, removed afterwards.
class TemporaryFile {
  public:
    TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] Bytes bytes() const;

  private:
    std::string path_;
};

/// While it lives no file of this process grows beyond `bytes`: a write fails as on a full disk (EFBIG).
class FullDisk {
  public:
    explicit FullDisk(std::size_t bytes);
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk();

  private:
    rlimit before_{};
    void (*handler_)(int);
};

/// What a writer that `fill` was given leaves in its file.
[[nodiscard]] Bytes written(const std::function<void(ledger::LogWriter&)>& fill);
/// A chunk by hand: type, size as told, body; its checksums are zlib's.
void appendChunk(Bytes& bytes, std::uint32_t type, std::uint32_t size, const Bytes& body);
[[nodiscard]] ledger::Event event(ledger::EventKind kind, ledger::ActorId actor, ledger::ObjectId object,
                                  std::uint64_t value, std::uint64_t time_ns = 0, std::uint64_t duration_ns = 0);
/// Everything of a log as lines of text, then "end: closed" or "end: truncated", or "error: ...".
[[nodiscard]] std::vector<std::string> told(const Bytes& bytes);

/// Two actors, a timeline, a resource with facts, one hand-off: every type of chunk.
void writeHandOff(ledger::LogWriter& log);

}  // namespace sluice::test
