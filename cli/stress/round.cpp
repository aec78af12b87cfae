// SPDX-License-Identifier: MIT
#include "stress/round.hpp"

#include <utility>

namespace sluice::stress {
namespace {

/// Timelines are free to jump, and do: by 1 to 10,000, as the conformance tests' wait-before-signal does.
constexpr std::uint32_t kMostIncrement = 10'000;

}  // namespace

Course::Course(Pattern pattern, const Shape& shape, std::uint64_t seed)
    : pattern_(pattern), slots_{shape}, seed_(seed), chance_(seed ^ 0x5A5A5A5A5A5A5A5AULL) {
    version_.assign(slots_.count(), 0);
}

void Course::rebuilt() {
    host_value_ = renderer_value_ = 0;
    host_of_ = renderer_of_ = {};
    restart();
}

void Course::restart() {
    version_.assign(slots_.count(), 0);
    done_.clear();
}

Turn Course::turn(std::vector<std::uint32_t> inputs, std::uint32_t output) {
    Turn made;
    // A slot that was never written has nothing to be read.
    std::erase_if(inputs, [this](std::uint32_t slot) { return version_[slot] == 0; });
    for (const std::uint32_t slot : inputs) {
        made.input_versions.push_back(version_[slot]);
    }
    made.inputs = std::move(inputs);
    made.output = output;
    made.version = ++turns_;
    made.salt = saltOf(seed_, turns_);
    version_[output] = made.version;
    done_.push_back(made);
    return made;
}

Turn Course::scribble(std::uint32_t output) {
    Turn made;
    made.output = output;
    made.version = ++turns_;
    made.salt = saltOf(seed_, turns_);
    return made;
}

/// One-way patterns carry their chain on in memory of the reader's own.
void Course::carry(std::vector<std::uint32_t>& inputs, std::uint32_t& output) {
    inputs.push_back(slots_.own(parity_));
    parity_ ^= 1U;
    output = slots_.own(parity_);
}

void Course::addGlTurn(Round& round) {
    std::vector<std::uint32_t> inputs;
    std::uint32_t output = slots_.host(round.set);
    if (pattern_ == Pattern::VkToGl) {
        carry(inputs, output);
    }
    for (std::uint32_t j = 0; j < slots_.shape.fan && pattern_ != Pattern::GlToVk; ++j) {
        inputs.push_back(slots_.renderer(round.set, j));
    }
    round.gl_wait = renderer_of_.at(round.set);
    round.gl = turn(std::move(inputs), output);
    round.gl_signal = host_value_ += chance_.between(1, kMostIncrement);
    host_of_.at(round.set) = round.gl_signal;
}

void Course::addVulkanTurns(Round& round) {
    for (std::uint32_t j = 0; j < slots_.shape.fan; ++j) {
        std::vector<std::uint32_t> inputs;
        std::uint32_t output = slots_.renderer(round.set, j);
        if (pattern_ == Pattern::GlToVk) {
            carry(inputs, output);
        }
        if (pattern_ != Pattern::VkToGl) {
            inputs.push_back(slots_.host(round.set));
        }
        Hand hand;
        hand.wait = host_of_.at(round.set);
        hand.waits = hand.wait != 0;
        hand.signal = renderer_value_ += chance_.between(1, kMostIncrement);
        renderer_of_.at(round.set) = hand.signal;
        round.vulkan.push_back(turn(std::move(inputs), output));
        round.hands.push_back(hand);
    }
}

Round Course::next(std::uint32_t number) {
    Round round;
    round.number = number;
    round.set = static_cast<std::uint32_t>(rounds_ % slots_.shape.sets);
    round.frame = ++rounds_;
    if (pattern_ == Pattern::VkToGl) {
        addVulkanTurns(round);
        addGlTurn(round);
    } else {
        addGlTurn(round);
        addVulkanTurns(round);
    }
    return round;
}

std::vector<Turn> Course::takeTurns() {
    return std::exchange(done_, {});
}

}  // namespace sluice::stress
