// SPDX-License-Identifier: MIT
// The Vulkan side of the stress test: device, resources, the renderer's end of the timelines, turns. No Vulkan type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "stress/chain.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

/// The two timelines of a relay, besides those of the renderer.
enum class RelayLeg : std::uint8_t { FromGl, ToGl };

/// signal, wait and the relay's calls from any thread; the rest on one.
class VkSide {
  public:
    /// On the device of `host`.
    [[nodiscard]] static Result<std::unique_ptr<VkSide>> create(const SluiceHostCapabilities& host);
    VkSide(const VkSide&) = delete;
    VkSide& operator=(const VkSide&) = delete;
    /// Waits for the queue: call drain() first where it may be stuck.
    ~VkSide();

    [[nodiscard]] const SluiceRendererCapabilities& capabilities() const;

    /// New resources and timelines in the place of the old; the queue must be idle.
    [[nodiscard]] Status allocate(const Storage& storage);
    [[nodiscard]] Result<ExportedSlot> exportSlot(std::uint32_t slot) const;

    /// Records and submits one turn.
    [[nodiscard]] Status submit(const Turn& turn, const Hand& hand);

    /// host-to-renderer reaches `value`. The renderer's own guard refuses a value that does not increase.
    [[nodiscard]] Status signal(std::uint64_t value);
    /// For renderer-to-host: OK, TIMEOUT or a failure.
    [[nodiscard]] SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns) const;
    [[nodiscard]] Status relaySignal(RelayLeg leg, std::uint64_t value);
    [[nodiscard]] SluiceResult relayWait(RelayLeg leg, std::uint64_t value, std::uint64_t timeout_ns) const;

    /// True once everything that was submitted has ended.
    [[nodiscard]] bool drain(std::uint64_t timeout_ns);
    /// Texels of a slot; nothing may use it meanwhile.
    [[nodiscard]] Result<std::vector<std::byte>> read(std::uint32_t slot);

  private:
    struct State;
    explicit VkSide(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sluice::stress
