// SPDX-License-Identifier: MIT
// When a renderer that has failed is created again: counted in frames, bounded, and the same on every machine.
#pragma once

#include <cstdint>

namespace sluice::host {

/// What FluidHost does about a renderer of which nothing more can be had.
struct RecoveryPolicy {
    /// So often in a row a new renderer is tried, one frame after the fault, then 2, 4, 8 ... frames after the last
    /// try. 0: never; the fault stays until the FluidHost is created again.
    std::uint32_t attempts = 5;
    /// So many frames in a row without fluid for the renderer's sake (a deadline, an error that is no caller's) are a
    /// fault. A lost device is one at once, an argument that was refused never.
    std::uint32_t strikes = 2;
    /// After so many frames with fluid the tries are counted from the beginning.
    std::uint32_t settled_frames = 64;
};

/// Counts frames and tries. Pure: what is done about it is the caller's.
class Recovery {
  public:
    enum class Step : std::uint8_t {
        None,     ///< there is nothing to recover from
        Wait,     ///< this frame goes without fluid
        Try,      ///< now; then tried() tells how it went
        GivenUp,  ///< as many tries as were allowed have failed
    };

    explicit Recovery(const RecoveryPolicy& policy) : policy_(policy) {}

    /// The renderer has become useless in this frame. Nothing when it was already.
    void fault();
    /// A new frame begins.
    [[nodiscard]] Step nextFrame();
    void tried(bool succeeded);
    void frameWithFluid();
    /// As many tries again as at the beginning, the first at once.
    void allowTriesAgain();

    [[nodiscard]] bool down() const { return down_; }
    [[nodiscard]] bool givenUp() const { return down_ && tries_ >= policy_.attempts; }
    /// Tries since the tries were counted from the beginning, and frames until the next one.
    [[nodiscard]] std::uint32_t tries() const { return tries_; }
    [[nodiscard]] std::uint32_t framesToGo() const { return to_go_; }
    [[nodiscard]] const RecoveryPolicy& policy() const { return policy_; }

  private:
    RecoveryPolicy policy_;
    bool down_ = false;
    std::uint32_t tries_ = 0;
    std::uint32_t to_go_ = 0;
    std::uint32_t clean_ = 0;
};

}  // namespace sluice::host
