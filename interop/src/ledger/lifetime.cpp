// SPDX-License-Identifier: MIT
// Begin and end of things: memory that crosses, descriptors, destruction.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {
namespace {

using Uuid = std::array<std::uint8_t, 16>;

std::string hex(const Uuid& uuid) {
    std::string text;
    for (const auto byte : uuid) {
        text += fmt::format("{:02x}", byte);
    }
    return text;
}

/// A side that cannot tell leaves zeros.
bool differ(const Uuid& a, const Uuid& b) {
    return a != Uuid{} && b != Uuid{} && a != b;
}

}  // namespace

void Ledger::State::descriptor(const Event& event) {
    const auto old = fds.find(event.object);
    if (event.kind == EventKind::FdOpen) {
        fds[event.object] = {FdState::Open, event};
        return;
    }
    if (old == fds.end()) {
        return;  // opened before the log began
    }
    if (event.kind == EventKind::FdGive) {
        old->second = {FdState::Given, event};
        return;
    }
    if (old->second.state != FdState::Open) {
        const Event& before = old->second.last;
        if (auto* found = report(FindingKind::FdClosedTwice, event.object, before, event)) {
            found->sentence =
                fmt::format("{} closes descriptor {} in frame {}, which {} has {} in frame {}.", name(event.actor),
                            event.object, event.frame, name(before.actor),
                            old->second.state == FdState::Given ? "given away" : "closed already", before.frame);
            found->remedy = fmt::format("Let {} forget descriptor {} once it is closed or given away.",
                                        name(event.actor), event.object);
        }
    }
    old->second = {FdState::Closed, event};
}

void Ledger::State::leakedDescriptors() {
    for (const auto& [number, fd] : fds) {
        if (fd.state != FdState::Open) {
            continue;
        }
        if (auto* found = report(FindingKind::FdLeaked, number, fd.last, fd.last)) {
            found->sentence = fmt::format("Descriptor {}, opened by {} in frame {}, was never closed or given away.",
                                          number, name(fd.last.actor), fd.last.frame);
            found->remedy = fmt::format("Close descriptor {} in {}, or hand it to the import that takes it over.",
                                        number, name(fd.last.actor));
        }
    }
}

void Ledger::State::memory(const Event& event, Resource& resource) {
    if (!resource.told) {
        return;  // nothing is known of the memory
    }
    const std::pair<Event, MemoryFacts> here{event, *resource.told};
    resource.told.reset();
    if (event.kind == EventKind::Export) {
        resource.exported = here;
        for (const auto& imported : std::exchange(resource.imports, {})) {
            compareMemory(resource, imported);
        }
    } else if (resource.exported) {
        compareMemory(resource, here);
    } else {
        resource.imports.push_back(here);
    }
}

void Ledger::State::compareMemory(const Resource& resource, const std::pair<Event, MemoryFacts>& imported) {
    const auto& [export_event, made] = *resource.exported;
    const auto& [import_event, taken] = imported;
    const auto tell = [&, &exporting = export_event, &importing = import_event](
                          FindingKind kind, const std::string& what, const std::string& here,
                          const std::string& there) {
        if (auto* found = report(kind, resource.id, exporting, importing)) {
            found->edge = fmt::format("{0}:export({1}) -> {2}:import({1})", name(exporting.actor), resource.name,
                                      name(importing.actor));
            found->sentence =
                fmt::format("{} imports {} with {} {}, but {} exported it with {}.", name(importing.actor),
                            resource.name, what, there, name(exporting.actor), here);
        }
    };
    if (differ(made.device_uuid, taken.device_uuid)) {
        tell(FindingKind::ImportUuid, "device UUID", hex(made.device_uuid), hex(taken.device_uuid));
    } else if (differ(made.driver_uuid, taken.driver_uuid)) {
        tell(FindingKind::ImportUuid, "driver UUID", hex(made.driver_uuid), hex(taken.driver_uuid));
    }
    if (made.dedicated != taken.dedicated) {
        tell(FindingKind::ImportDedicated, "the dedicated flag", std::to_string(made.dedicated),
             std::to_string(taken.dedicated));
    }
    if (made.tiling != taken.tiling) {
        const auto text = [](std::uint32_t tiling) { return tiling == 0 ? std::string("optimal") : "linear"; };
        tell(FindingKind::ImportTiling, "tiling", text(made.tiling), text(taken.tiling));
    }
    if (made.size != taken.size && made.size != 0 && taken.size != 0) {
        tell(FindingKind::ImportSize, "size", std::to_string(made.size), std::to_string(taken.size));
    }
}

void Ledger::State::destroy(Actor& by, const Item& item) {
    if (item.slot == kNoSlot) {
        return;
    }
    const Event& event = item.event;
    const bool is_sync = event.aux == static_cast<std::uint16_t>(ObjectClass::Sync);
    const std::string& object_name = is_sync ? syncs[item.slot].name : resources[item.slot].name;
    const auto tell = [&](FindingKind kind, const Event& use, const char* what) {
        if (auto* found = report(kind, event.object, use, event)) {
            found->sentence =
                fmt::format("{} destroys {} in frame {}, but {} the {} by {} in frame {}.", by.name, object_name,
                            event.frame, what, toString(use.kind), name(use.actor), use.frame);
            found->remedy = fmt::format("Let {} wait for something that {} signals after that, then destroy {}.",
                                        by.name, name(use.actor), object_name);
        }
    };
    const char* const unordered = "nothing says that it has outlived";
    if (is_sync) {
        Sync& sync = syncs[item.slot];
        const auto kind =
            sync.kind == SyncKind::Binary ? FindingKind::BinaryReusedPending : FindingKind::UseAfterDestroy;
        if (sync.destroyed) {
            tell(FindingKind::UseAfterDestroy, *sync.destroyed, "it is gone since");
        } else if (!sync.waiters.empty()) {
            tell(kind,
                 actors[sync.waiters.front()].queue.empty() ? event : actors[sync.waiters.front()].queue.front().event,
                 "still pending is");
        } else {
            for (const SyncUse& use : sync.uses) {
                if (!by.after(use.at)) {
                    tell(kind, use.last, unordered);
                    break;
                }
            }
        }
        sync.destroyed = event;
        sync.blamed = true;
        return;
    }
    Resource& resource = resources[item.slot];
    if (resource.destroyed) {
        tell(FindingKind::UseAfterDestroy, *resource.destroyed, "it is gone since");
    } else if (resource.write_at.tick != 0 && !by.after(resource.write_at)) {
        tell(FindingKind::UseAfterDestroy, resource.write_event, unordered);
    } else if (resource.behind && !by.after(resource.behind->last)) {
        tell(FindingKind::UseAfterDestroy, resource.behind->last_event, unordered);
    } else {
        const auto busy = std::find_if(resource.reads.begin(), resource.reads.end(),
                                       [&](const ReadMark& mark) { return mark.active && !by.after(mark.at); });
        if (busy != resource.reads.end()) {
            tell(FindingKind::UseAfterDestroy, busy->event, unordered);
        }
    }
    needed(by, resource.write_at);
    resource.destroyed = event;
}

}  // namespace sluice::ledger
