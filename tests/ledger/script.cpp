// SPDX-License-Identifier: MIT
#include "script.hpp"

namespace sluice::ledger::test {

Script::Script(LedgerOptions options) : ledger(options) {
    ledger.declareActor(kGl, ActorKind::GlContext, "gl");
    ledger.declareActor(kQueue, ActorKind::VulkanQueue, "queue");
    ledger.declareActor(kEngine, ActorKind::HostThread, "engine");
    ledger.declareActor(kBridge, ActorKind::BridgeThread, "bridge");
    ledger.declareActor(kQueue2, ActorKind::VulkanQueue, "queue2");
    ledger.declareSync(kHost, SyncKind::Timeline, "host-to-renderer", 0, 0);
    ledger.declareSync(kDone, SyncKind::Timeline, "renderer-to-host", 0, 0);
    ledger.declareSync(kBinary, SyncKind::Binary, "semaphore", 0, 0);
    ledger.declareSync(kFence, SyncKind::Fence, "fence", 0, 0);
    ledger.declareSync(kListed, SyncKind::Timeline, "listed", 0, kListedOnly);
    ledger.declareResource(kColour, "colour", 1, kNoActor);
    ledger.declareResource(kDepth, "depth", 1, kNoActor);
}

void Script::event(EventKind kind, ActorId by, ObjectId object, std::uint64_t value, std::uint16_t aux,
                   std::uint16_t flags, std::uint64_t duration_ns) {
    Event event;
    event.kind = kind;
    event.actor = by;
    event.object = object;
    event.value = value;
    event.aux = aux;
    event.flags = flags;
    event.time_ns = now_ += 1000;
    event.duration_ns = duration_ns;
    event.sequence = sequence_++;
    ledger.record(event);
}

void Script::signal(ActorId by, ObjectId sync, std::uint64_t value, std::uint16_t flags) {
    event(EventKind::Signal, by, sync, value, 0, flags);
}

void Script::wait(ActorId by, ObjectId sync, std::uint64_t value, std::uint64_t duration_ns, std::uint16_t flags) {
    event(EventKind::Wait, by, sync, value, 0, flags, duration_ns);
}

void Script::waitBegin(ActorId by, ObjectId sync, std::uint64_t value) {
    event(EventKind::WaitBegin, by, sync, value);
}

void Script::submit(ActorId by, ActorId stream) {
    event(EventKind::Submit, by, stream);
}

void Script::read(ActorId by, ObjectId resource, std::uint64_t version) {
    event(EventKind::Read, by, resource, version);
}

void Script::write(ActorId by, ObjectId resource, std::uint64_t version) {
    event(EventKind::Write, by, resource, version);
}

void Script::release(ActorId by, ObjectId resource, std::uint32_t from, std::uint32_t to, ActorId other) {
    event(EventKind::Release, by, resource, std::uint64_t{to} << 32U | from, other);
}

void Script::acquire(ActorId by, ObjectId resource, std::uint32_t from, std::uint32_t to, ActorId other) {
    event(EventKind::Acquire, by, resource, std::uint64_t{to} << 32U | from, other);
}

void Script::layout(ActorId by, ObjectId resource, std::uint32_t from, std::uint32_t to) {
    event(EventKind::Layout, by, resource, std::uint64_t{to} << 32U | from);
}

void Script::names(ActorId by, ObjectId resource, std::uint32_t layout) {
    event(EventKind::Names, by, resource, layout);
}

void Script::destroy(ActorId by, ObjectClass what, ObjectId object) {
    event(EventKind::Destroy, by, object, 0, static_cast<std::uint16_t>(what));
}

void Script::witness(ActorId by, ObjectId resource, std::uint64_t version, Verdict verdict) {
    event(EventKind::Witness, by, resource, version, static_cast<std::uint16_t>(verdict));
}

std::vector<FindingKind> kinds(const Ledger& ledger) {
    std::vector<FindingKind> all;
    for (const Finding& finding : ledger.findings()) {
        all.push_back(finding.kind);
    }
    return all;
}

std::string tell(const Ledger& ledger) {
    std::string text;
    for (const Finding& finding : ledger.findings()) {
        text += std::string(findingInfo(finding.kind).id) + ": " + finding.sentence + " | " + finding.remedy + " | " +
                finding.edge + '\n';
        for (const auto& line : finding.chain) {
            text += "    " + line + '\n';
        }
    }
    return text;
}

}  // namespace sluice::ledger::test
