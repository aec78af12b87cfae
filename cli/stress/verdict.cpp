// SPDX-License-Identifier: MIT
#include "stress/verdict.hpp"

#include <fmt/format.h>

namespace sluice::stress {

std::optional<std::string> whyFailed(const Seen& seen) {
    const bool pixels = seen.bad_texels > 0;
    const bool ledger = seen.findings > 0;
    if (seen.fault == Fault::None || seen.fault == Fault::Delay) {
        if (!pixels && !ledger) {
            return std::nullopt;
        }
        return fmt::format("{} wrong texels, {} findings of the ledger{}", seen.bad_texels, seen.findings,
                           pixels && !ledger   ? ": in order by the model, so suspect the driver"
                           : ledger && !pixels ? ": the contents were right by luck"
                                               : "");
    }
    // The ledger finds these two because the test itself books what it does; what has to be shown is that they were
    // made good.
    if ((seen.fault == Fault::Drop || seen.fault == Fault::Duplicate) && pixels) {
        return fmt::format("{} wrong texels after a {}, which spoils none", seen.bad_texels, toString(seen.fault));
    }
    const bool late = seen.fault == Fault::Duplicate || seen.fault == Fault::Swap;
    const std::uint64_t doubled = late && seen.injected ? 1 : 0;
    if (seen.refused != doubled) {
        return fmt::format("the renderer's guard refused {} signals, {} were given too late", seen.refused, doubled);
    }
    if (seen.injected && !pixels && !ledger) {
        return fmt::format("the {} was seen by nobody", toString(seen.fault));
    }
    return std::nullopt;
}

}  // namespace sluice::stress
