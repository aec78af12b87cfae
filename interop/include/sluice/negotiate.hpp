// SPDX-License-Identifier: MIT
// Choosing formats and a timeline: a pure function of what both sides can do, which returns its reasons.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// What the caller wants.
struct NegotiationRequest {
    SluiceTimelineKind timeline = SLUICE_TIMELINE_AUTO;
    std::uint32_t outputs = 0;                     ///< FLUID_* roles wanted, SLUICE_ROLE_BIT
    SluiceFormat host_depth = SLUICE_FORMAT_NONE;  ///< forced format of HOST_DEPTH, or NONE
    std::uint32_t failed_formats = 0;              ///< bit per SluiceFormat whose canary failed on this machine
};

/// One candidate and why it was taken or passed over.
struct Reason {
    std::string subject;  ///< "timeline native", "HOST_DEPTH D32F", "device"
    bool accepted = false;
    std::string why;  ///< "GL_NV_timeline_semaphore is missing"
};

/// The agreement.
struct Agreement {
    SluiceTimelineKind timeline = SLUICE_TIMELINE_FINISH;
    std::array<SluiceFormat, SLUICE_IMAGE_ROLE_COUNT> formats{};
    SluiceDepthEncoding host_depth_encoding = SLUICE_DEPTH_WINDOW;
    std::vector<Reason> reasons;  ///< every candidate that was considered, in order
};

/// The preference list of formats for a role, best first. Empty for CANARY.
[[nodiscard]] std::vector<SluiceFormat> formatCandidates(SluiceImageRole role);

/// True if some GL device UUID and the driver UUID equal the Vulkan device's, all 16 bytes of each.
[[nodiscard]] bool sameDevice(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk);

/// Pure. Fails when the devices differ, memory cannot be shared, a role has no format left, or a forced choice is not
/// possible; the error then names the first obstacle and its remedy. `reasons_on_failure`, if given, receives what was
/// considered until then.
[[nodiscard]] Result<Agreement> negotiate(const SluiceHostCapabilities& gl, const SluiceRendererCapabilities& vk,
                                          const NegotiationRequest& request,
                                          std::vector<Reason>* reasons_on_failure = nullptr);

}  // namespace sluice
