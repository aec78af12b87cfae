// SPDX-License-Identifier: MIT
// Negotiation with proof: every format of the agreement has made a canary round trip on this machine.
#pragma once

#include "device/device.hpp"
#include "sluice/negotiate.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Negotiates, proves what was chosen, strikes what fails and negotiates again, until all that is chosen is proven or
/// nothing is left. Every reason goes to the log, one line each.
[[nodiscard]] Result<Agreement> agree(const Device& device, const SluiceHostServices& host,
                                      const SluiceCreateInfo& info);

}  // namespace sluice::vk
