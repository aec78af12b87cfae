// SPDX-License-Identifier: MIT
// The OpenGL side of the stress test: context, imported resources, turns, the host's end of the timelines. No GL type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sluice/timeline.hpp"
#include "stress/chain.hpp"
#include "stress/options.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

/// Everything on one thread, whose current context this is from create() on.
class GlSide {
  public:
    [[nodiscard]] static Result<std::unique_ptr<GlSide>> create();
    GlSide(const GlSide&) = delete;
    GlSide& operator=(const GlSide&) = delete;
    ~GlSide();

    [[nodiscard]] const SluiceHostCapabilities& capabilities() const;
    /// Why turns over `resource` cannot be computed here, or empty.
    [[nodiscard]] std::string missingFor(Resource resource) const;

    /// New resources in the place of the old: one exported slot per shared slot, and the side's own.
    [[nodiscard]] Status allocate(const Storage& storage, std::vector<ExportedSlot> shared);
    /// Lets go of resources and of the timeline.
    void clear();
    /// The host's end for a backend and topology. `api` and `renderer` are what it signals and waits through.
    [[nodiscard]] Status makeTimeline(Backend backend, Topology topology, const SluiceRendererApi& api,
                                      SluiceRenderer* renderer);
    [[nodiscard]] HostTimeline& timeline() { return *timeline_; }
    void clearTimeline() { timeline_.reset(); }

    /// Issues one turn.
    void run(const Turn& turn);
    /// Texels of a slot.
    [[nodiscard]] Result<std::vector<std::byte>> read(std::uint32_t slot);

  private:
    struct State;
    explicit GlSide(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
    std::unique_ptr<HostTimeline> timeline_;  // before the context
};

}  // namespace sluice::stress
