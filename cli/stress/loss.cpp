// SPDX-License-Identifier: MIT
#include "stress/loss.hpp"

namespace sluice::stress {

bool dropUnderWay(const Signals& signals) {
    return signals.to_drop > signals.rescued;
}

bool signalLost(const Signals& signals) {
    return signals.dropped > signals.rescued && signals.past >= signals.promised;
}

}  // namespace sluice::stress
