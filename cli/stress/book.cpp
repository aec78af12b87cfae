// SPDX-License-Identifier: MIT
#include "stress/book.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sluice/ledger/finding.hpp"
#include "sluice/ledger/log.hpp"
#include "sluice/trace.hpp"

namespace sluice::stress {
namespace {

using ledger::ActorKind;
using ledger::EventKind;
using ledger::SyncKind;

constexpr std::size_t kMostLines = 1'000'000;  ///< of one epoch; a longer one keeps its beginning

constexpr std::array<std::pair<ActorKind, const char*>, 6> kActors{{{ActorKind::GlContext, "gl"},
                                                                    {ActorKind::VulkanQueue, "queue"},
                                                                    {ActorKind::HostThread, "host"},
                                                                    {ActorKind::BridgeThread, "bridge"},
                                                                    {ActorKind::BridgeThread, "relay out"},
                                                                    {ActorKind::BridgeThread, "relay back"}}};
constexpr std::array<const char*, 4> kTimelines{"host-to-renderer", "renderer-to-host", "gl-to-relay", "relay-to-gl"};

ledger::LedgerOptions options() {
    ledger::LedgerOptions chosen;
    chosen.performance = false;  // a stress test waits more than it needs, on purpose
    return chosen;
}

std::string slotName(const Slots& slots, std::uint32_t slot) {
    if (slot < slots.shape.sets) {
        return fmt::format("host image {}", slot);
    }
    const std::uint32_t rest = slot - slots.shape.sets;
    return fmt::format("renderer image {}.{}", rest / slots.shape.fan, rest % slots.shape.fan);
}

/// Into a ledger or a log writer: both take the same declarations.
template <typename Target>
void declareAll(Target& target, const Storage& storage, const std::array<std::uint64_t, 4>& initial) {
    for (ledger::ObjectId id = 0; id < kTimelines.size(); ++id) {
        target.declareSync(id, SyncKind::Timeline, kTimelines.at(id), initial.at(id), 0);
    }
    for (std::uint32_t slot = 0; slot < storage.slots.shared(); ++slot) {
        target.declareResource(slot, slotName(storage.slots, slot), 1, ledger::kNoActor);
    }
}

template <typename Target>
void declareActors(Target& target) {
    ledger::ActorId id = 0;
    for (const auto& [kind, name] : kActors) {
        target.declareActor(id++, kind, name);
    }
}

}  // namespace

Book::Book() : ledger_(options()) {
    declareActors(ledger_);
}

void Book::declare(const Storage& storage) {
    const std::lock_guard guard(mutex_);
    storage_ = storage;
    reached_ = at_checkpoint_ = {};
    fence_of_ = {};  // the same values come again
    lines_.clear();
    declareAll(ledger_, storage, reached_);
}

void Book::add(const ledger::Event& event) {
    if (event.kind == EventKind::Signal && event.object < reached_.size()) {
        std::uint64_t& reached = reached_.at(event.object);
        reached = std::max(reached, event.value);
    }
    ledger_.record(event);
    if (lines_.size() < kMostLines) {
        lines_.push_back({event, false});
    }
}

void Book::event(EventKind kind, ledger::ActorId by, ledger::ObjectId object, std::uint64_t value, std::uint16_t aux,
                 std::uint16_t flags, std::uint64_t duration_ns) {
    ledger::Event event;
    event.kind = kind;
    event.actor = by;
    event.object = object;
    event.value = value;
    event.aux = aux;
    event.flags = flags;
    event.time_ns = monotonicNanoseconds() - duration_ns;
    event.duration_ns = duration_ns;
    const std::lock_guard guard(mutex_);
    add(event);
}

void Book::fence(std::uint64_t value) {
    ledger::Event event;
    event.kind = EventKind::Signal;
    event.actor = kGl;
    event.time_ns = monotonicNanoseconds();
    const std::lock_guard guard(mutex_);
    const std::uint32_t index = next_fence_++ % kFences;
    fence_of_.at(index) = value;
    event.object = kFirstFence + index;
    ledger_.declareSync(event.object, SyncKind::Fence, fmt::format("fence of {}", value), 0, 0);
    if (lines_.size() < kMostLines) {
        ledger::Event declaration = event;
        declaration.value = value;
        lines_.push_back({declaration, true});
    }
    add(event);
}

void Book::fenceArrived(ledger::ActorId by, std::uint64_t value) {
    ledger::Event event;
    event.kind = EventKind::Wait;
    event.actor = by;
    event.time_ns = monotonicNanoseconds();
    const std::lock_guard guard(mutex_);
    const auto found = std::find(fence_of_.begin(), fence_of_.end(), value);
    if (found != fence_of_.end()) {
        event.object = kFirstFence + static_cast<ledger::ObjectId>(found - fence_of_.begin());
        add(event);
    }
}

void Book::checkpoint() {
    const std::lock_guard guard(mutex_);
    lines_.clear();
    at_checkpoint_ = reached_;
}

void Book::finish() {
    const std::lock_guard guard(mutex_);
    ledger_.finish(ledger::End::Closed);
}

std::uint64_t Book::troubles() const {
    const std::lock_guard guard(mutex_);
    std::uint64_t sum = ledger_.findingsDropped();
    for (const ledger::Finding& finding : ledger_.findings()) {
        sum += ledger::findingInfo(finding.kind).severity == ledger::Severity::Info ? 0 : finding.count;
    }
    return sum;
}

std::vector<std::string> Book::told() const {
    const std::lock_guard guard(mutex_);
    std::vector<std::string> lines;
    for (const ledger::Finding& finding : ledger_.findings()) {
        const ledger::FindingInfo& info = ledger::findingInfo(finding.kind);
        if (info.severity != ledger::Severity::Info) {
            lines.push_back(fmt::format("{} ({}): {}", info.id, finding.count, finding.sentence));
        }
    }
    return lines;
}

std::vector<std::string> Book::waitChain(ledger::ActorId actor) const {
    const std::lock_guard guard(mutex_);
    return ledger_.waitChain(actor);
}

Status Book::writeLog(const std::string& path) const {
    auto created = ledger::LogWriter::create(path);
    if (!created) {
        return created.error();
    }
    ledger::LogWriter& log = *created.value();
    const std::lock_guard guard(mutex_);
    declareActors(log);
    declareAll(log, storage_, at_checkpoint_);
    for (const Line& line : lines_) {
        if (line.declares_fence) {
            log.declareSync(line.event.object, SyncKind::Fence, fmt::format("fence of {}", line.event.value), 0, 0);
        } else {
            log.record(line.event);
        }
    }
    return log.close();
}

}  // namespace sluice::stress
