// SPDX-License-Identifier: MIT
// The log: what was written is read, and no damage does more than end the reading with a place and a reason.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <thread>

#include "log_bytes.hpp"
#include "sluice/ledger/ledger.hpp"

namespace sluice::test {
namespace {

using ledger::Event;
using ledger::EventKind;
using ledger::LogWriter;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Bytes header() {
    return written([](LogWriter&) {});
}
/// Without the close chunk that the writer ends with.
Bytes open(Bytes bytes) {
    bytes.resize(bytes.size() - 16);
    return bytes;
}
Bytes raw(const Event& event) {
    Bytes bytes(sizeof(event));
    std::memcpy(bytes.data(), &event, sizeof(event));
    return bytes;
}
std::string lastLine(const Bytes& bytes) {
    return told(bytes).back();
}

TEST(LedgerLog, WhatWasWrittenIsReadInItsOrder) {
    EXPECT_THAT(told(written(writeHandOff)),
                ElementsAre("actor 0 GL context gl", "actor 1 Vulkan queue queue", "sync 0 timeline ready 0 0",
                            "resource 0 colour 1 65535", "memory 0 4096 0 1", "0 frame 0 0 1 0 0 1000 0",
                            "1 write 0 0 1 0 0 1100 0", "2 signal 0 0 1 0 0 1200 0", "3 wait 1 0 1 0 0 1150 0",
                            "4 read 1 0 1 0 0 1300 0", "end: closed"));
}

TEST(LedgerLog, AnEmptyLogIsHeaderAndClose) {
    EXPECT_EQ(header().size(), 32U);
    EXPECT_THAT(told(header()), ElementsAre("end: closed"));
    EXPECT_THAT(told(open(header())), ElementsAre("end: truncated"));
}

TEST(LedgerLog, DeclarationsStandBeforeTheEventsThatFollowThem) {
    const auto lines = told(written([](LogWriter& log) {
        log.declareSync(7, ledger::SyncKind::Fence, "first", 0, 0);
        log.record(event(EventKind::Signal, 0, 7, 0));
        log.declareSync(7, ledger::SyncKind::Fence, "second", 0, 0);
        log.record(event(EventKind::Signal, 0, 7, 0));
    }));
    EXPECT_THAT(lines, ElementsAre(StartsWith("sync 7 fence first"), StartsWith("0 signal"),
                                   StartsWith("sync 7 fence second"), StartsWith("1 signal"), "end: closed"));
}

TEST(LedgerLog, ALongLogCrossesManyBuffersWhole) {
    constexpr std::uint64_t kEvents = 10000;  // 480 kB in buffers of 64 KiB
    const Bytes bytes = written([](LogWriter& log) {
        for (std::uint64_t i = 0; i < kEvents; ++i) {
            log.record(event(EventKind::Signal, 0, 0, i + 1));
        }
    });
    std::uint64_t expected = 0;
    ledger::LogSink sink;
    sink.event = [&](const Event& e) {
        EXPECT_EQ(e.sequence, expected);
        EXPECT_EQ(e.value, ++expected);
    };
    const auto summary = ledger::readLog(bytes, "test.log", sink);
    ASSERT_TRUE(summary.ok());
    EXPECT_EQ(summary.value().events, kEvents);
}

TEST(LedgerLog, ADiskThatIsFullAtTheLastMarkIsToldByClose) {
    const TemporaryFile file;
    auto writer = LogWriter::create(file.path());
    ASSERT_TRUE(writer.ok());
    writer.value()->record(event(EventKind::Signal, 0, 0, 1));
    const FullDisk disk(16 + 16 + 48);  // header and one event: no room for the mark
    writer.value()->flush();
    EXPECT_TRUE(writer.value()->status().ok());
    const Status closed = writer.value()->close();
    ASSERT_FALSE(closed.ok());
    EXPECT_THAT(closed.error().message(), HasSubstr(file.path() + "': cannot write it: File too large"));
    EXPECT_EQ(told(file.bytes()).back(), "end: truncated");
}

TEST(LedgerLog, WhatComesAfterCloseIsDropped) {
    const TemporaryFile file;
    auto writer = LogWriter::create(file.path());
    ASSERT_TRUE(writer.ok());
    EXPECT_TRUE(writer.value()->close().ok());
    writer.value()->record(event(EventKind::Signal, 0, 0, 1));
    writer.value()->flush();
    EXPECT_TRUE(writer.value()->close().ok());
    EXPECT_THAT(told(file.bytes()), ElementsAre("end: closed"));
}

TEST(LedgerLog, NamesAreCutBetweenTwoCharacters) {
    std::string name(1023, 'n');
    name += "\xC3\xA9";  // the cut would fall inside it
    const auto lines = told(written([&](LogWriter& log) { log.declareActor(0, ledger::ActorKind::Process, name); }));
    EXPECT_EQ(lines.front(), "actor 0 process " + name.substr(0, 1023));
}

TEST(LedgerLog, ControlCharactersOfNamesDoNotReachATerminal) {
    const auto lines = told(written([](LogWriter& log) {
        log.declareActor(0, ledger::ActorKind::Process, "a\x1b[2J\nb");
        log.declareResource(0, "\xC3\xA9\x7F", 0, 0);
    }));
    EXPECT_THAT(lines, ElementsAre("actor 0 process a?[2J?b", "resource 0 \xC3\xA9? 0 0", "end: closed"));
}

TEST(LedgerLog, ManyThreadsWriteOneLog) {
    constexpr std::uint64_t kEach = 2000;
    const Bytes bytes = written([](LogWriter& log) {
        std::vector<std::thread> threads;
        for (ledger::ActorId actor = 0; actor < 4; ++actor) {
            threads.emplace_back([&log, actor] {
                for (std::uint64_t i = 1; i <= kEach; ++i) {
                    if (i % 100 == 0) {
                        log.declareResource(actor, "r", 0, actor);
                        log.flush();
                    }
                    log.record(event(EventKind::Signal, actor, actor, i));
                }
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
    });
    std::array<std::uint64_t, 4> last{};
    ledger::LogSink sink;
    sink.event = [&](const Event& e) { EXPECT_EQ(e.value, ++last.at(e.actor)) << "each actor's own order is kept"; };
    ASSERT_TRUE(ledger::readLog(bytes, "test.log", sink).ok());
    EXPECT_THAT(last, ::testing::Each(kEach));
}

TEST(LedgerLog, WhatWasFlushedSurvivesACrash) {
    const TemporaryFile file;
    const pid_t child = fork();
    if (child == 0) {
        auto writer = LogWriter::create(file.path());
        writeHandOff(*writer.value());
        writer.value()->flush();
        writer.value()->record(event(EventKind::Signal, 0, 0, 2));
        _exit(0);  // no destructor: a crash
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    const auto lines = told(file.bytes());
    EXPECT_THAT(lines.back(), "end: truncated");
    EXPECT_THAT(lines[lines.size() - 2], StartsWith("4 read"));
}

TEST(LedgerLog, AFullDiskIsToldWithTheNumberOfLostRecords) {
    auto writer = LogWriter::create("/dev/full");
    ASSERT_FALSE(writer.ok()) << "the header itself could not be written";
    EXPECT_THAT(writer.error().message(), HasSubstr("/dev/full"));
    EXPECT_THAT(writer.error().message(), HasSubstr("No space left on device"));

    // A pipe whose reader has gone fails later than at the header.
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    const auto old = signal(SIGPIPE, SIG_IGN);
    auto piped = LogWriter::create(fmt::format("/proc/self/fd/{}", ends[1]));
    ASSERT_TRUE(piped.ok()) << piped.error().message();
    close(ends[0]);
    piped.value()->record(event(EventKind::Signal, 0, 0, 1));
    EXPECT_TRUE(piped.value()->status().ok()) << "nothing was written yet";
    piped.value()->flush();
    for (int i = 0; i < 3; ++i) {
        piped.value()->record(event(EventKind::Signal, 0, 0, 2));
    }
    EXPECT_THAT(piped.value()->status().error().message(), HasSubstr("3 records dropped"));
    piped = Error{};
    close(ends[1]);
    signal(SIGPIPE, old);
}

TEST(LedgerLog, AMissingFolderIsNamed) {
    const auto writer = LogWriter::create("/no/such/folder/a.log");
    ASSERT_FALSE(writer.ok());
    EXPECT_THAT(writer.error().message(), HasSubstr("'/no/such/folder/a.log': cannot create it: No such file"));
}

TEST(LedgerLogDamage, FilesThatAreNoLogsSaySo) {
    EXPECT_THAT(lastLine({}), StartsWith("error: test.log: at byte 0: expected a header of 16 bytes, found 0"));
    Bytes text(100, std::byte{'x'});
    EXPECT_THAT(lastLine(text), StartsWith("error: test.log: at byte 0: expected \"SLUICELG\""));
    Bytes later = header();
    later[8] = std::byte{3};
    EXPECT_THAT(lastLine(later), StartsWith("error: test.log: at byte 8: expected version 2 of the format, found 3"));
    Bytes earlier = header();
    earlier[8] = std::byte{1};
    EXPECT_THAT(lastLine(earlier),
                AllOf(HasSubstr("expected version 2 of the format, found 1"), HasSubstr("record it anew")));
    Bytes wider = header();
    wider[12] = std::byte{56};
    EXPECT_THAT(lastLine(wider), StartsWith("error: test.log: at byte 12: expected events of 48 bytes, found 56"));
    const auto missing = ledger::readLog("/no/such.log", {});
    ASSERT_FALSE(missing.ok());
    EXPECT_THAT(missing.error().message(), HasSubstr("/no/such.log: cannot be opened: No such file"));
    EXPECT_THAT(ledger::readLog("/tmp", {}).error().message(), HasSubstr("/tmp: is a folder"));
}

TEST(LedgerLogDamage, AbsurdSizesAreErrorsAndAllocateNothing) {
    for (const std::uint32_t type : {1U, 2U, 3U, 4U, 5U, 6U, 77U}) {
        Bytes bytes = open(header());
        appendChunk(bytes, type, 0xFFFFFFF0, {});
        EXPECT_THAT(lastLine(bytes), StartsWith("error: test.log: at byte 20: expected a chunk of at most 16777216"))
            << type;
    }
    Bytes bytes = open(header());
    appendChunk(bytes, 2, 3, Bytes(3));
    EXPECT_THAT(lastLine(bytes), HasSubstr("at byte 20: expected a chunk of 4 to 1028 bytes, found 3"));
    bytes = open(header());
    appendChunk(bytes, 1, 47, Bytes(47));
    EXPECT_THAT(lastLine(bytes), HasSubstr("at byte 20: expected a multiple of 48 bytes of events, found 47"));
}

TEST(LedgerLogDamage, AnUnknownChunkIsSkipped) {
    Bytes bytes = open(header());
    appendChunk(bytes, 77, 10000, Bytes(10000));
    appendChunk(bytes, 1, 48, raw(event(EventKind::Signal, 0, 0, 5)));
    EXPECT_THAT(told(bytes), ElementsAre("0 signal 0 0 5 0 0 0 0", "end: truncated"));
}

/// As a disk that lost a sector leaves it: no number there is out of bounds.
TEST(LedgerLogDamage, BytesOverwrittenNameTheirChunk) {
    const Bytes whole = written([](LogWriter& log) {
        for (std::uint64_t i = 1; i <= 1000; ++i) {
            log.record(event(EventKind::Signal, 0, 0, i));
        }
    });
    EXPECT_EQ(whole.size(), 16U + 4 * 16 + 1000 * 48 + 16) << "events in chunks of 256 at most";
    Bytes bytes = whole;
    bytes.at(16 + 16 + 256 * 48 + 16 + 3 * 48 + 16) ^= std::byte{1};  // a time in the second chunk
    const std::string found = lastLine(bytes);
    EXPECT_THAT(found, HasSubstr("at byte 12336: expected the contents of a chunk with checksum "));
    EXPECT_THAT(found, HasSubstr("the file is damaged here; record it anew"));
    bytes = whole;
    bytes.at(16 + 16 + 256 * 48) = std::byte{9};  // the type of the second
    EXPECT_THAT(lastLine(bytes), HasSubstr("at byte 12320: expected the head of a chunk with checksum "));
}

TEST(LedgerLogDamage, NothingMayFollowTheClose) {
    Bytes bytes = header();
    bytes.push_back(std::byte{'x'});
    EXPECT_THAT(lastLine(bytes), HasSubstr("at byte 32: expected the end of the file after the close, found more"));
    bytes.pop_back();
    appendChunk(bytes, 1, 0, {});
    EXPECT_THAT(lastLine(bytes), HasSubstr("at byte 32: expected the end of the file after the close, found more"));
}

TEST(LedgerLogDamage, KindsAndIdsOutOfBoundsNameTheirPlace) {
    struct Case {
        Event event;
        const char* message;
    };
    Event kind = event(EventKind::Signal, 0, 0, 0);
    kind.kind = static_cast<EventKind>(200);
    Event owner = event(EventKind::Acquire, 0, 0, 0);
    owner.aux = 5000;
    Event sort = event(EventKind::Destroy, 0, 0, 0);
    sort.aux = 3;
    Event verdict = event(EventKind::Witness, 0, 0, 0);
    verdict.aux = 3;
    const std::vector<Case> cases{
        {kind, "at byte 32: expected a kind of event below 19, found 200"},
        {event(EventKind::Signal, 1024, 0, 0), "at byte 36: expected an actor below 1024, found 1024"},
        {event(EventKind::Wait, 0, 1U << 24U, 0), "at byte 40: expected a sync object below 16777216"},
        {event(EventKind::Write, 0, 0xFFFFFFF0, 0), "at byte 40: expected a resource below"},
        {event(EventKind::Submit, 0, 60000, 0), "at byte 40: expected a stream below 1024"},
        {owner, "at byte 38: expected the other owner below 1024, found 5000"},
        {sort, "at byte 38: expected a class of object below 3"},
        {verdict, "at byte 38: expected a verdict below 3"},
    };
    for (const Case& one : cases) {
        Bytes bytes = open(header());
        appendChunk(bytes, 1, 48, raw(one.event));
        EXPECT_THAT(lastLine(bytes), HasSubstr(one.message));
    }
    // The number of a descriptor, and the second event of a chunk.
    Bytes bytes = open(header());
    Bytes two = raw(event(EventKind::FdOpen, 0, 0x7FFFFFFF, 0));
    const Bytes bad = raw(kind);
    two.insert(two.end(), bad.begin(), bad.end());
    appendChunk(bytes, 1, 96, two);
    EXPECT_THAT(lastLine(bytes), HasSubstr("at byte 80: expected a kind of event"));
}

TEST(LedgerLogDamage, DeclarationsOutOfBoundsNameTheirPlace) {
    Bytes actor = open(header());
    appendChunk(actor, 2, 4, {std::byte{0}, std::byte{4}, std::byte{0}, std::byte{0}});
    EXPECT_THAT(lastLine(actor), HasSubstr("at byte 32: expected an actor below 1024, found 1024"));
    Bytes kind = open(header());
    appendChunk(kind, 2, 4, {std::byte{0}, std::byte{0}, std::byte{9}, std::byte{0}});
    EXPECT_THAT(lastLine(kind), HasSubstr("at byte 34: expected a kind of actor below 5, found 9"));
    Bytes sync = open(header());
    appendChunk(sync, 3, 16, Bytes(16, std::byte{0xFF}));
    EXPECT_THAT(lastLine(sync), HasSubstr("at byte 32: expected a sync object below"));
    Bytes resource = open(header());
    appendChunk(resource, 4, 12, Bytes(12, std::byte{0xFF}));
    EXPECT_THAT(lastLine(resource), HasSubstr("at byte 32: expected a resource below"));
}

TEST(LedgerLogDamage, IdsMayComeInAnyOrderAndSequencesAreThePlaces) {
    Event late = event(EventKind::Signal, 900, 80000, 1);
    late.sequence = 55;
    Event early = event(EventKind::Signal, 3, 2, 1);
    early.sequence = 1;
    Bytes bytes = open(header());
    appendChunk(bytes, 1, 48, raw(late));
    appendChunk(bytes, 1, 48, raw(early));
    EXPECT_THAT(told(bytes),
                ElementsAre(StartsWith("0 signal 900 80000"), StartsWith("1 signal 3 2"), "end: truncated"));
}

TEST(LedgerLogDamage, ALogCutAnywhereIsReadUpToThere) {
    const Bytes whole = written(writeHandOff);
    const auto all = told(whole);
    for (std::size_t size = 16; size < whole.size(); ++size) {
        const auto lines = told(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
        ASSERT_EQ(lines.back(), "end: truncated") << size;
        ASSERT_TRUE(std::equal(lines.begin(), lines.end() - 1, all.begin()))
            << "a prefix of the whole, cut at " << size;
    }
}

/// The whole chain that `sluice diagnose` puts a log through.
void judge(const Bytes& bytes) {
    ledger::Ledger ledger;
    const auto summary = ledger::readLog(bytes, "test.log", sinkInto(ledger));
    ledger.finish(summary ? summary.value().end : ledger::End::Truncated);
    ASSERT_LT(ledger.memoryBytes(), std::size_t{64} << 20U);
}

TEST(LedgerLogDamage, EveryBitFlippedAndEveryByteSetIsFound) {
    const Bytes whole = written(writeHandOff);
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::vector<std::byte> values{std::byte{0x00}, std::byte{0x7F}, std::byte{0xFF}};
        for (unsigned bit = 0; bit < 8; ++bit) {
            values.push_back(whole[at] ^ static_cast<std::byte>(1U << bit));
        }
        for (const std::byte value : values) {
            Bytes bytes = whole;
            bytes[at] = value;
            ASSERT_THAT(lastLine(bytes),
                        value == whole[at] ? HasSubstr("end: closed") : HasSubstr("error: test.log: at byte "))
                << at;
            judge(bytes);
        }
    }
}

}  // namespace
}  // namespace sluice::test
