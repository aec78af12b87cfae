// SPDX-License-Identifier: MIT
// One round of a pattern, laid down before any of it is done: who reads and writes what, in which versions, and which
// values go with it. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stress/chain.hpp"
#include "stress/chance.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

struct Round {
    std::uint32_t number = 0;  ///< within its epoch
    std::uint64_t frame = 0;   ///< within the run, from 1
    std::uint32_t set = 0;
    Turn gl;
    std::uint64_t gl_wait = 0;    ///< renderer-to-host value before the turn of OpenGL; 0: none
    std::uint64_t gl_signal = 0;  ///< host-to-renderer value after it
    std::vector<Turn> vulkan;
    std::vector<Hand> hands;  ///< one per turn of Vulkan
};

/// Where the run stands: the content of every slot, the values of both timelines.
class Course {
  public:
    Course(Pattern pattern, const Shape& shape, std::uint64_t seed);

    /// Resources and timelines are new.
    void rebuilt();
    /// The chains begin anew in the same resources.
    void restart();
    [[nodiscard]] Round next(std::uint32_t number);
    /// The turn of a writer that does not wait: over `output`, and nothing that anybody expects.
    [[nodiscard]] Turn scribble(std::uint32_t output);

    [[nodiscard]] const Slots& slots() const { return slots_; }
    /// Turns since the last call, in the order in which they must seem to happen.
    [[nodiscard]] std::vector<Turn> takeTurns();
    [[nodiscard]] std::uint64_t version(std::uint32_t slot) const { return version_.at(slot); }
    [[nodiscard]] std::uint64_t lastHost() const { return host_value_; }
    [[nodiscard]] std::uint64_t lastRenderer() const { return renderer_value_; }

  private:
    void addGlTurn(Round& round);
    void addVulkanTurns(Round& round);
    [[nodiscard]] Turn turn(std::vector<std::uint32_t> inputs, std::uint32_t output);
    void carry(std::vector<std::uint32_t>& inputs, std::uint32_t& output);

    Pattern pattern_;
    Slots slots_;
    std::uint64_t seed_;
    Chance chance_;
    std::uint64_t turns_ = 0, rounds_ = 0, host_value_ = 0, renderer_value_ = 0;
    std::uint32_t parity_ = 0;
    std::vector<std::uint64_t> version_;                             // of each slot; 0: not written
    std::array<std::uint64_t, kMaxSets> host_of_{}, renderer_of_{};  // last values of each set
    std::vector<Turn> done_;
};

}  // namespace sluice::stress
