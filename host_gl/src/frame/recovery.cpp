// SPDX-License-Identifier: MIT
#include "sluice/host_gl/recovery.hpp"

#include <algorithm>

namespace sluice::host {

namespace {

// 2^20 frames are hours; whoever allows more tries than that gets them at this distance.
constexpr std::uint32_t kMostDoublings = 20;

std::uint32_t delayBefore(std::uint32_t tries) {
    return 1U << std::min(tries, kMostDoublings);
}

}  // namespace

void Recovery::fault() {
    if (down_) {
        return;
    }
    down_ = true;
    clean_ = 0;
    to_go_ = delayBefore(tries_);
}

Recovery::Step Recovery::nextFrame() {
    if (!down_) {
        return Step::None;
    }
    if (givenUp()) {
        return Step::GivenUp;
    }
    if (to_go_ > 1) {
        --to_go_;
        return Step::Wait;
    }
    return Step::Try;
}

void Recovery::tried(bool succeeded) {
    ++tries_;
    if (succeeded) {
        down_ = false;
        return;
    }
    to_go_ = delayBefore(tries_);
}

void Recovery::frameWithFluid() {
    if (tries_ > 0 && ++clean_ >= policy_.settled_frames) {
        tries_ = 0;
        clean_ = 0;
    }
}

void Recovery::allowTriesAgain() {
    tries_ = 0;
    clean_ = 0;
    to_go_ = 1;
}

}  // namespace sluice::host
