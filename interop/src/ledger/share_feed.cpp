// SPDX-License-Identifier: MIT
#include "sluice/ledger/share_feed.hpp"

#include <algorithm>
#include <exception>
#include <span>

#include "hand_off_roles.hpp"
#include "sluice/trace.hpp"

namespace sluice::ledger {
namespace {

using Uuid = std::array<std::uint8_t, SLUICE_UUID_SIZE>;

Uuid uuid(std::span<const std::uint8_t, SLUICE_UUID_SIZE> bytes) {
    Uuid copy{};
    std::copy(bytes.begin(), bytes.end(), copy.begin());
    return copy;
}

/// That of the context's devices which is the renderer's, or else its first.
Uuid deviceOf(const SluiceHostCapabilities& host, const Uuid& renderers) {
    const std::uint32_t count = std::min(host.device_uuid_count, SLUICE_MAX_DEVICE_UUIDS);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (uuid(host.device_uuids[i]) == renderers) {
            return renderers;
        }
    }
    return count == 0 ? Uuid{} : uuid(host.device_uuids[0]);
}

/// A record that is lost is no reason to lose the frame.
template <typename Call>
void kept(const Call& call) noexcept {
    try {
        call();
    } catch (const std::exception&) {
    }
}

Event eventOf(EventKind kind, ActorId actor, ObjectId object) {
    Event event;
    event.kind = kind;
    event.actor = actor;
    event.object = object;
    event.time_ns = monotonicNanoseconds();
    return event;
}

}  // namespace

ShareFeed::ShareFeed(LiveLedger& ledger) : ledger_(ledger) {
    const RendererLife life = ledger_.rendererLife();
    ledger_.declareActor(kHostThread, ActorKind::HostThread, life.nameOf("host thread"));
    ledger_.declareActor(kRenderer, ActorKind::Process, life.nameOf("renderer"));
}

ShareFeed::~ShareFeed() {
    kept([&] { ledger_.record(eventOf(EventKind::ActorEnd, kRenderer, kNoObject)); });
}

void ShareFeed::put(EventKind kind, ActorId actor, int fd) {
    if (fd >= 0) {
        ledger_.record(eventOf(kind, actor, static_cast<ObjectId>(fd)));
    }
}

void ShareFeed::trace(const SluiceTraceEvent& event) noexcept {
    kept([&] {
        const std::optional<ExportMark> mark = exportMark(event);
        if (mark) {
            const std::lock_guard lock(mutex_);
            images_[{mark->role, mark->image_set}] = {mark, {}, std::nullopt};
            put(EventKind::FdOpen, kRenderer, mark->fd);
        }
    });
}

void ShareFeed::offered(const SluiceImageExport& image) noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        Image& known = images_[{image.role, image.image_set}];
        if (known.offer.struct_size != 0) {
            known = {};  // offered before: the mark belongs to that
        }
        known.offer = image;
        if (!known.mark || known.mark->fd != image.fd) {
            put(EventKind::FdOpen, kRenderer, image.fd);
        }
    });
}

void ShareFeed::imported(const SluiceImageExport& image, const MemoryFacts& told) noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        images_[{image.role, image.image_set}].told = told;
    });
}

void ShareFeed::handedBack(const SluiceImageExport& image) noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        images_.erase({image.role, image.image_set});
        put(EventKind::FdGive, kHostThread, image.fd);
    });
}

void ShareFeed::opened(int fd) noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        put(EventKind::FdOpen, kHostThread, fd);
    });
}

void ShareFeed::given(int fd) noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        put(EventKind::FdGive, kHostThread, fd);
    });
}

void ShareFeed::closed(int fd) noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        put(EventKind::FdClose, kHostThread, fd);
    });
}

void ShareFeed::compare(const Key& at, const Image& image, const SluiceRendererCapabilities& renderer,
                        const SluiceHostCapabilities& host) {
    if (!image.told) {
        return;
    }
    const ObjectId id = resourceOf(at.first, at.second);
    MemoryFacts made;
    made.device_uuid = uuid(renderer.device_uuid);
    made.driver_uuid = uuid(renderer.driver_uuid);
    made.size = image.mark ? image.mark->size : image.offer.allocation_size;
    made.dedicated = image.mark ? image.mark->dedicated : image.offer.dedicated;
    made.tiling = 0;  // optimal: there is no other for a SluiceImageExport
    ledger_.recordMemory(eventOf(EventKind::Export, kRenderer, id), made);
    MemoryFacts taken = *image.told;
    taken.device_uuid = deviceOf(host, made.device_uuid);
    taken.driver_uuid = uuid(host.driver_uuid);
    ledger_.recordMemory(eventOf(EventKind::Import, kHostThread, id), taken);
}

void ShareFeed::imagesMade(const SluiceRendererCapabilities& renderer, const SluiceHostCapabilities& host) noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        for (const auto& [at, image] : images_) {
            compare(at, image, renderer, host);
        }
        images_.clear();
    });
}

void ShareFeed::forget() noexcept {
    const std::lock_guard lock(mutex_);
    images_.clear();
}

void ShareFeed::canaryEnds() noexcept {
    kept([&] {
        const std::lock_guard lock(mutex_);
        const auto found = images_.find({SLUICE_IMAGE_CANARY, 0});
        if (found == images_.end()) {
            return;
        }
        const ObjectId id = resourceOf(SLUICE_IMAGE_CANARY, 0);
        ledger_.declareResource(id, "canary", static_cast<std::uint32_t>(kGeneral), kHostThread);
        compare(found->first, found->second, {}, {});  // whose device it is the renderer tells later
        Event gone = eventOf(EventKind::Destroy, kHostThread, id);
        gone.aux = static_cast<std::uint16_t>(ObjectClass::Resource);
        ledger_.record(gone);
        images_.erase(found);
    });
}

}  // namespace sluice::ledger
