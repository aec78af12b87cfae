// SPDX-License-Identifier: MIT
#include "plugin/agree.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "plugin/prove.hpp"
#include "sluice/canary.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {
namespace {

void logReasons(const Device& device, const std::vector<Reason>& reasons) {
    for (const Reason& reason : reasons) {
        device.log(SLUICE_LOG_INFO,
                   fmt::format("{} {}: {}", reason.accepted ? "take" : "pass", reason.subject, reason.why));
    }
}

}  // namespace

Result<Agreement> agree(const Device& device, const SluiceHostServices& host, const SluiceCreateInfo& info) {
    NegotiationRequest request;
    request.timeline = static_cast<SluiceTimelineKind>(info.timeline);
    request.outputs = info.outputs;
    request.host_depth = static_cast<SluiceFormat>(info.host_depth_format);
    std::uint32_t proven = 0;
    std::string struck;
    for (;;) {
        std::vector<Reason> reasons;
        Result<Agreement> agreement = negotiate(info.host, device.capabilities, request, &reasons);
        if (!agreement) {
            logReasons(device, reasons);
            Error error = agreement.error();
            error.detail += struck;
            return error;
        }
        bool complete = true;
        for (const SluiceFormat format : agreement.value().formats) {
            const FormatInfo* row = findFormat(format);
            if (row == nullptr || ((proven | request.failed_formats) & formatBit(format)) != 0) {
                continue;
            }
            const Status status =
                proveFormat(device, host, format, kCanaryWidth, kCanaryHeight, static_cast<std::uint32_t>(format));
            if (status) {
                proven |= formatBit(format);
                device.log(SLUICE_LOG_INFO, fmt::format("canary {}: every texel of {}x{} crossed both ways", row->name,
                                                        kCanaryWidth, kCanaryHeight));
                continue;
            }
            if (status.error().code == SLUICE_ERROR_DEVICE_LOST) {
                return status.error();
            }
            complete = false;
            request.failed_formats |= formatBit(format);
            struck += fmt::format("; {} struck: {}", row->name, status.error().message());
            device.log(SLUICE_LOG_WARNING, fmt::format("canary {}: {}", row->name, status.error().message()));
        }
        if (complete) {
            logReasons(device, agreement.value().reasons);
            return agreement;
        }
    }
}

}  // namespace sluice::vk
