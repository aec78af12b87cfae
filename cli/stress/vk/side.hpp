// SPDX-License-Identifier: MIT
// The Vulkan side of the stress test: device, resources, the renderer's end of the timelines, turns. No Vulkan type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "stress/chain.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

/// The two timelines of a relay, besides those of the renderer.
enum class RelayLeg : std::uint8_t { FromGl, ToGl };

/// signal, wait and the relay's calls from any thread; the rest on one. In this process (create) or in another
/// (stress/process/side.hpp).
class VkSide {
  public:
    /// In this process, on the device of `host`.
    [[nodiscard]] static Result<std::unique_ptr<VkSide>> create(const SluiceHostCapabilities& host);
    VkSide() = default;
    VkSide(const VkSide&) = delete;
    VkSide& operator=(const VkSide&) = delete;
    /// Waits for the queue: call drain() first where it may be stuck.
    virtual ~VkSide() = default;

    [[nodiscard]] virtual const SluiceRendererCapabilities& capabilities() const = 0;

    /// New resources and timelines in the place of the old; the queue must be idle.
    [[nodiscard]] virtual Status allocate(const Storage& storage) = 0;
    [[nodiscard]] virtual Result<ExportedSlot> exportSlot(std::uint32_t slot) = 0;

    /// Records and submits one turn.
    [[nodiscard]] virtual Status submit(const Turn& turn, const Hand& hand) = 0;

    /// host-to-renderer reaches `value`. The renderer's own guard refuses a value that does not increase.
    [[nodiscard]] virtual Status signal(std::uint64_t value) = 0;
    /// For renderer-to-host: OK, TIMEOUT or a failure.
    [[nodiscard]] virtual SluiceResult wait(std::uint64_t value, std::uint64_t timeout_ns) = 0;
    [[nodiscard]] virtual Status relaySignal(RelayLeg leg, std::uint64_t value) = 0;
    [[nodiscard]] virtual SluiceResult relayWait(RelayLeg leg, std::uint64_t value, std::uint64_t timeout_ns) = 0;

    /// True once everything that was submitted has ended, or when nothing can be under way any more.
    [[nodiscard]] virtual bool drain(std::uint64_t timeout_ns) = 0;
    /// Texels of a slot; nothing may use it meanwhile.
    [[nodiscard]] virtual Result<std::vector<std::byte>> read(std::uint32_t slot) = 0;

    /// Why no call can succeed any more; a process can end, a part of this one cannot.
    [[nodiscard]] virtual std::optional<Error> lost() { return std::nullopt; }
    /// Descriptors that are open in a process other than this one.
    [[nodiscard]] virtual Result<std::uint64_t> descriptorsElsewhere() { return std::uint64_t{0}; }
};

}  // namespace sluice::stress
