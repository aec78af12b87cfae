// SPDX-License-Identifier: MIT
// Which frame's depth which value of a simulation collides with, and the buffers that hold them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "memory/buffer.hpp"

namespace sluice::vk {

/// What depths are captured into.
struct DepthBuffer {
    Buffer memory;
    std::uint32_t number = 0;  ///< among those that there are, from 0
    /// By which name the trace knows it.
    [[nodiscard]] std::string name() const;
};

/// One that nobody holds.
struct DepthRoom {
    std::shared_ptr<const DepthBuffer> buffer;  ///< none: nothing is captured
    std::uint64_t freed = 0;  ///< which letting go of the solver's this comes after, counted from 1; 0: it never had
                              ///< it, or a frame before has come after it
};

/// What a frame has captured, or will have when it ends.
struct SeenDepth {
    std::shared_ptr<const DepthBuffer> buffer;  ///< none: nothing has been captured yet
    std::uint64_t signal = 0;                   ///< value of the renderer's timeline at which it is there
};

/// Value v collides with the depth of the frame that draws value v - lag, but at least 1; value 1 with none. A frame
/// that captures nothing leaves what the value before it had; values that no frame draws, too. A buffer is used again
/// when nobody holds it any more, neither a value, nor a frame, nor the solver. Guarded by whoever owns it.
class SeenDepths {
  public:
    explicit SeenDepths(std::uint32_t lag) : lag_(lag) {}

    /// Whose frame `value` needs; 0: none.
    [[nodiscard]] std::uint64_t sourceOf(std::uint64_t value) const;
    [[nodiscard]] Result<DepthRoom> room(const Device& device, VkDeviceSize bytes);
    /// The solver lets go of that buffer, for the `freed`-th time that it does so of any.
    void letGo(const DepthBuffer& buffer, std::uint64_t freed);

    /// The first frame that draws `value` has been submitted.
    void drawn(std::uint64_t value, SeenDepth captured);
    /// No frame will draw `value` or one before it any more.
    void passed(std::uint64_t value);
    [[nodiscard]] bool known(std::uint64_t value) const { return value <= known_; }
    [[nodiscard]] SeenDepth at(std::uint64_t value) const;
    /// No value needs those before `value` any more.
    void forget(std::uint64_t value);

  private:
    std::uint32_t lag_;
    std::uint64_t known_ = 0;
    std::map<std::uint64_t, SeenDepth> seen_;  ///< by value, where it is another than that of the value before
    std::vector<std::shared_ptr<const DepthBuffer>> buffers_;
    std::vector<std::uint64_t> freed_;  ///< by number of the buffer, of those before it with that number, too
};

}  // namespace sluice::vk
