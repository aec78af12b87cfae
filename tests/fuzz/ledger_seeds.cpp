// SPDX-License-Identifier: MIT
#include "ledger_seeds.hpp"

#include <functional>

#include "sluice/ledger/log.hpp"

namespace sluice::fuzz {
namespace {

using ledger::EventKind;
using ledger::LogWriter;

void put(LogWriter& log, EventKind kind, ledger::ActorId actor, ledger::ObjectId object, std::uint64_t value,
         std::uint16_t aux = 0, std::uint16_t flags = 0) {
    ledger::Event event;
    event.kind = kind;
    event.actor = actor;
    event.object = object;
    event.value = value;
    event.aux = aux;
    event.flags = flags;
    event.time_ns = 1000 + 10 * value;
    log.record(event);
}

void declare(LogWriter& log) {
    log.declareActor(0, ledger::ActorKind::GlContext, "gl");
    log.declareActor(1, ledger::ActorKind::VulkanQueue, "queue");
    log.declareActor(2, ledger::ActorKind::HostThread, "host");
    log.declareSync(0, ledger::SyncKind::Timeline, "t", 0, 0);
    log.declareSync(1, ledger::SyncKind::Binary, "b", 0, ledger::kListedOnly);
    log.declareSync(2, ledger::SyncKind::Fence, "f", 0, 0);
    log.declareResource(0, "image", 1, 0);
}

void handOff(LogWriter& log) {
    declare(log);
    for (std::uint64_t k = 1; k <= 2; ++k) {
        put(log, EventKind::Frame, 2, 0, k);
        put(log, EventKind::Submit, 2, 0, k);
        put(log, EventKind::Write, 0, 0, k);
        put(log, EventKind::Signal, 0, 0, k);
        put(log, EventKind::Wait, 1, 0, k);
        put(log, EventKind::Read, 1, 0, k);
        put(log, EventKind::Signal, 1, 2, 0);
        put(log, EventKind::WaitBegin, 2, 2, 0);
        put(log, EventKind::Wait, 2, 2, 0);
    }
}

void listed(LogWriter& log) {
    declare(log);
    put(log, EventKind::Release, 0, 0, (2ULL << 32U) | 1U, 1);
    put(log, EventKind::Names, 0, 0, 2);
    put(log, EventKind::Signal, 0, 1, 0);
    put(log, EventKind::Names, 1, 0, 2);
    put(log, EventKind::Wait, 1, 1, 0);
    put(log, EventKind::Acquire, 1, 0, (2ULL << 32U) | 1U, 0);
    put(log, EventKind::Layout, 1, 0, (7ULL << 32U) | 2U);
    put(log, EventKind::Witness, 1, 0, 1, 1);
    put(log, EventKind::ActorEnd, 0, 0, 0);
}

void waiting(LogWriter& log) {
    declare(log);
    put(log, EventKind::Wait, 1, 0, 5);
    put(log, EventKind::Signal, 1, 0, 4);
    put(log, EventKind::Wait, 0, 0, 4);
    put(log, EventKind::Signal, 0, 0, 5);
    put(log, EventKind::WaitBegin, 2, 0, 9);
    put(log, EventKind::Wait, 2, 0, 9, 0, ledger::kTimedOut);
    put(log, EventKind::Signal, 2, 0, 9, 0, ledger::kForced);
}

void memory(LogWriter& log) {
    declare(log);
    ledger::MemoryFacts facts;
    facts.size = 4096;
    log.memoryFacts(0, facts);
    put(log, EventKind::Export, 1, 0, 0);
    put(log, EventKind::FdOpen, 2, 5, 1);
    put(log, EventKind::FdGive, 2, 5, 1);
    put(log, EventKind::FdClose, 2, 5, 1);
    facts.dedicated = 1;
    log.memoryFacts(0, facts);
    put(log, EventKind::Import, 0, 0, 0);
    for (std::uint16_t sort = 0; sort < 3; ++sort) {
        put(log, EventKind::Destroy, 0, 0, 0, sort);
    }
    put(log, EventKind::Read, 0, 0, 0);
}

}  // namespace

bool writeLedgerSeeds(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const auto write = [&folder](const char* name, void (*fill)(LogWriter&)) {
        auto log = LogWriter::create((folder / name).string());
        if (log) {
            fill(*log.value());
            log.value()->flush();
        }
        return log.ok() && log.value()->status().ok();
    };
    return write("empty", [](LogWriter&) {}) && write("hand-off", handOff) && write("listed", listed) &&
           write("waiting", waiting) && write("memory", memory);
}

}  // namespace sluice::fuzz
