// SPDX-License-Identifier: MIT
// What a Sluice host tells the ledger of the memory that crosses: what the renderer exported and what OpenGL was told,
// and what became of every descriptor. All of it happens at start-up and at a resize; no frame has a part in it.
//
// It begins before the renderer does, and so before anybody knows how the two take turns (HandOffFeed): images are
// kept until they are declared there.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "sluice/export_mark.hpp"
#include "sluice/ledger/hand_off_feed.hpp"
#include "sluice/ledger/live.hpp"
#include "sluice/plugin.h"

namespace sluice::ledger {

/// The renderer as a whole, beside its queue: who exports.
inline constexpr ActorId kRenderer = 5;

/// Any thread. No call throws: what cannot be recorded is lost.
class ShareFeed {
  public:
    /// The ledger must outlive the feed.
    explicit ShareFeed(LiveLedger& ledger);
    ShareFeed(const ShareFeed&) = delete;
    ShareFeed& operator=(const ShareFeed&) = delete;
    /// The renderer is gone.
    ~ShareFeed();

    /// The renderer's own word (sluice/export_mark.hpp); all else is passed over.
    void trace(const SluiceTraceEvent& event) noexcept;

    /// The renderer brings an image, by share_image or canary.
    void offered(const SluiceImageExport& image) noexcept;
    /// OpenGL has its memory, as `told`; the UUIDs are filled in later.
    void imported(const SluiceImageExport& image, const MemoryFacts& told) noexcept;
    /// It was refused: its descriptor is the renderer's again.
    void handedBack(const SluiceImageExport& image) noexcept;

    // Descriptors, as they change hands in this process. Told before a number is let go of, and after it was taken: in
    // between somebody else may be given it.
    void opened(int fd) noexcept;
    void given(int fd) noexcept;  ///< to OpenGL
    void closed(int fd) noexcept;

    /// HandOffFeed::imagesMade has been told: the two sides of each image are compared.
    void imagesMade(const SluiceRendererCapabilities& renderer, const SluiceHostCapabilities& host) noexcept;
    /// There will be no such images: start-up or resize has failed.
    void forget() noexcept;
    /// The same for the image of a canary, which is gone again.
    void canaryEnds() noexcept;

  private:
    /// What is known of one image so far.
    struct Image {
        std::optional<ExportMark> mark;
        SluiceImageExport offer{};
        std::optional<MemoryFacts> told;
    };
    using Key = std::pair<std::uint32_t, std::uint32_t>;  // role, set
    void put(EventKind kind, ActorId actor, int fd);
    void compare(const Key& at, const Image& image, const SluiceRendererCapabilities& renderer,
                 const SluiceHostCapabilities& host);

    LiveLedger& ledger_;
    std::mutex mutex_;  // guards what follows, and that the events of a descriptor come in its own order
    std::map<Key, Image> images_;
};

}  // namespace sluice::ledger
