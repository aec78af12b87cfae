// SPDX-License-Identifier: MIT
// What drivers do not say when there are no file descriptors left.
#pragma once

#include "sluice/result.hpp"

namespace sluice::host {

/// `status` again. A failure while hardly a descriptor is free says so: drivers then speak of missing drivers, of lost
/// memory or of nothing.
[[nodiscard]] Status withDescriptorNote(Status status);

}  // namespace sluice::host
