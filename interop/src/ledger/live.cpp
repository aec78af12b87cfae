// SPDX-License-Identifier: MIT
#include "sluice/ledger/live.hpp"

#include <algorithm>
#include <utility>

namespace sluice::ledger {

std::string RendererLife::nameOf(std::string_view actor) const {
    if (number <= 1) {
        return std::string(actor);
    }
    const bool teen = number % 100 / 10 == 1;
    const std::uint32_t last = teen ? 0 : number % 10;
    const char* ending = last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th";
    return std::string(actor) + ", " + std::to_string(number) + ending + " renderer";
}

LiveLedger::LiveLedger(LedgerOptions options, std::unique_ptr<LogWriter> log)
    : ledger_(options), log_(std::move(log)) {}

void LiveLedger::declareActor(ActorId id, ActorKind kind, std::string_view name) {
    const std::lock_guard lock(mutex_);
    const auto known = living_.find(id);
    const std::pair now(kind, std::string(name));
    if (finished_ || (known != living_.end() && known->second == now)) {
        return;
    }
    living_[id] = now;
    ledger_.declareActor(id, kind, name);
    if (log_) {
        log_->declareActor(id, kind, name);
    }
}

void LiveLedger::declareSync(ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial,
                             std::uint16_t flags) {
    const std::lock_guard lock(mutex_);
    if (finished_) {
        return;
    }
    ledger_.declareSync(id, kind, name, initial, flags);
    if (log_) {
        log_->declareSync(id, kind, name, initial, flags);
    }
}

void LiveLedger::declareResource(ObjectId id, std::string_view name, std::uint32_t layout, ActorId owner) {
    const std::lock_guard lock(mutex_);
    if (finished_) {
        return;
    }
    ledger_.declareResource(id, name, layout, owner);
    if (log_) {
        log_->declareResource(id, name, layout, owner);
    }
}

void LiveLedger::record(const Event& event) {
    const std::lock_guard lock(mutex_);
    if (finished_) {
        return;
    }
    if (event.kind == EventKind::ActorEnd) {
        living_.erase(event.actor);
    }
    ledger_.record(event);
    if (log_) {
        log_->record(event);
    }
}

void LiveLedger::recordMemory(const Event& event, const MemoryFacts& facts) {
    const std::lock_guard lock(mutex_);
    if (finished_) {
        return;
    }
    ledger_.memoryFacts(event.object, facts);
    ledger_.record(event);
    if (log_) {
        log_->memoryFacts(event.object, facts);
        log_->record(event);
    }
}

std::vector<std::string> LiveLedger::waitChain(ActorId actor) const {
    const std::lock_guard lock(mutex_);
    return ledger_.waitChain(actor);
}

void LiveLedger::rendererBegins(RendererLife life) {
    const std::lock_guard lock(mutex_);
    life_ = life;
}

RendererLife LiveLedger::rendererLife() const {
    const std::lock_guard lock(mutex_);
    return life_;
}

void LiveLedger::leaveUnchecked(Unchecked what) {
    const std::lock_guard lock(mutex_);
    if (!unchecked_) {
        unchecked_ = std::move(what);
    }
}

std::optional<Unchecked> LiveLedger::unchecked() const {
    const std::lock_guard lock(mutex_);
    if (unchecked_) {
        return unchecked_;
    }
    const std::vector<Unheard> unheard = ledger_.unheard();
    const auto lost = std::ranges::find_if(unheard, [](const Unheard& one) { return one.since_frame != 0; });
    return lost == unheard.end() ? std::nullopt : std::optional(Unchecked{lost->since_frame, lost->why});
}

Status LiveLedger::finish(End end) {
    const std::lock_guard lock(mutex_);
    if (finished_) {
        return {};
    }
    finished_ = true;
    ledger_.finish(end);
    if (!log_) {
        return {};
    }
    Status status = log_->close();
    log_.reset();
    return status;
}

std::vector<Finding> LiveLedger::findings() const {
    const std::lock_guard lock(mutex_);
    return ledger_.findings();
}

std::uint64_t LiveLedger::findingsDropped() const {
    const std::lock_guard lock(mutex_);
    return ledger_.findingsDropped();
}

std::uint64_t LiveLedger::eventsSeen() const {
    const std::lock_guard lock(mutex_);
    return ledger_.eventsSeen();
}

std::size_t LiveLedger::memoryBytes() const {
    const std::lock_guard lock(mutex_);
    return ledger_.memoryBytes();
}

}  // namespace sluice::ledger
