// SPDX-License-Identifier: MIT
#include "log_bytes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>

namespace sluice::test {

using ledger::EventKind;

TemporaryFile::TemporaryFile() : path_((std::filesystem::temp_directory_path() / "sluice-log-XXXXXX").string()) {
    const int fd = mkstemp(path_.data());
    if (fd >= 0) {
        close(fd);
    }
}

TemporaryFile::~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

Bytes TemporaryFile::bytes() const {
    std::ifstream file(path_, std::ios::binary);
    const std::vector<char> characters{std::istreambuf_iterator<char>(file), {}};
    const auto view = std::as_bytes(std::span(characters));
    return {view.begin(), view.end()};
}

FullDisk::FullDisk(std::size_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    EXPECT_EQ(getrlimit(RLIMIT_FSIZE, &before_), 0);
    const rlimit limit{bytes, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
}
FullDisk::~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
}

Bytes written(const std::function<void(ledger::LogWriter&)>& fill) {
    const TemporaryFile file;
    {
        auto writer = ledger::LogWriter::create(file.path());
        if (!writer) {
            return {};
        }
        fill(*writer.value());
    }
    return file.bytes();
}

void appendChunk(Bytes& bytes, std::uint32_t type, std::uint32_t size, const Bytes& body) {
    const auto put = [&bytes](std::uint32_t number) {
        std::array<std::byte, 4> raw{};
        std::memcpy(raw.data(), &number, raw.size());
        bytes.insert(bytes.end(), raw.begin(), raw.end());
    };
    const auto sum = [](std::span<const std::byte> of) {
        return static_cast<std::uint32_t>(
            ::crc32(0, reinterpret_cast<const Bytef*>(of.data()), static_cast<uInt>(of.size())));
    };
    const std::size_t head = bytes.size();
    put(type);
    put(size);
    put(body.empty() ? 0 : sum(body));
    put(sum(std::span(bytes).subspan(head)));
    bytes.insert(bytes.end(), body.begin(), body.end());
}

ledger::Event event(EventKind kind, ledger::ActorId actor, ledger::ObjectId object, std::uint64_t value,
                    std::uint64_t time_ns, std::uint64_t duration_ns) {
    ledger::Event made;
    made.kind = kind;
    made.actor = actor;
    made.object = object;
    made.value = value;
    made.time_ns = time_ns;
    made.duration_ns = duration_ns;
    return made;
}

std::vector<std::string> told(const Bytes& bytes) {
    std::vector<std::string> lines;
    ledger::LogSink sink;
    sink.actor = [&](ledger::ActorId id, ledger::ActorKind kind, std::string_view name) {
        lines.push_back(fmt::format("actor {} {} {}", id, toString(kind), name));
    };
    sink.sync = [&](ledger::ObjectId id, ledger::SyncKind kind, std::string_view name, std::uint64_t initial,
                    std::uint16_t flags) {
        lines.push_back(fmt::format("sync {} {} {} {} {}", id, toString(kind), name, initial, flags));
    };
    sink.resource = [&](ledger::ObjectId id, std::string_view name, std::uint32_t layout, ledger::ActorId owner) {
        lines.push_back(fmt::format("resource {} {} {} {}", id, name, layout, owner));
    };
    sink.memory = [&](ledger::ObjectId id, const ledger::MemoryFacts& facts) {
        lines.push_back(fmt::format("memory {} {} {} {}", id, facts.size, facts.tiling, facts.dedicated));
    };
    sink.event = [&](const ledger::Event& e) {
        lines.push_back(fmt::format("{} {} {} {} {} {} {} {} {}", e.sequence, toString(e.kind), e.actor, e.object,
                                    e.value, e.aux, e.flags, e.time_ns, e.duration_ns));
    };
    const Result<ledger::LogSummary> summary = ledger::readLog(bytes, "test.log", sink);
    lines.push_back(!summary                                     ? "error: " + summary.error().message()
                    : summary.value().end == ledger::End::Closed ? "end: closed"
                                                                 : "end: truncated");
    return lines;
}

void writeHandOff(ledger::LogWriter& log) {
    log.declareActor(0, ledger::ActorKind::GlContext, "gl");
    log.declareActor(1, ledger::ActorKind::VulkanQueue, "queue");
    log.declareSync(0, ledger::SyncKind::Timeline, "ready", 0, 0);
    log.declareResource(0, "colour", 1, ledger::kNoActor);
    ledger::MemoryFacts facts;
    facts.size = 4096;
    facts.dedicated = 1;
    log.memoryFacts(0, facts);
    log.record(event(EventKind::Frame, 0, 0, 1, 1000));
    log.record(event(EventKind::Write, 0, 0, 1, 1100));
    log.record(event(EventKind::Signal, 0, 0, 1, 1200));
    log.record(event(EventKind::Wait, 1, 0, 1, 1150));
    log.record(event(EventKind::Read, 1, 0, 1, 1300));
}

}  // namespace sluice::test
