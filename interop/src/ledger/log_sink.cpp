// SPDX-License-Identifier: MIT
#include "sluice/ledger/log.hpp"

namespace sluice::ledger {

LogSink sinkInto(Ledger& ledger) {
    LogSink sink;
    sink.actor = [&ledger](ActorId id, ActorKind kind, std::string_view name) { ledger.declareActor(id, kind, name); };
    sink.sync = [&ledger](ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial,
                          std::uint16_t flags) { ledger.declareSync(id, kind, name, initial, flags); };
    sink.resource = [&ledger](ObjectId id, std::string_view name, std::uint32_t layout, ActorId owner) {
        ledger.declareResource(id, name, layout, owner);
    };
    sink.memory = [&ledger](ObjectId id, const MemoryFacts& facts) { ledger.memoryFacts(id, facts); };
    sink.event = [&ledger](const Event& event) { ledger.record(event); };
    return sink;
}

}  // namespace sluice::ledger
