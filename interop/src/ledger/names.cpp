// SPDX-License-Identifier: MIT
// The words for the enumerators.
#include "sluice/ledger/event.hpp"
#include "sluice/ledger/finding.hpp"

namespace sluice::ledger {

std::string_view toString(EventKind kind) {
    constexpr std::array<std::string_view, kEventKindCount> kNames = {
        "signal", "wait",   "wait-begin", "submit",  "read",    "write",    "release", "acquire",   "layout", "names",
        "export", "import", "destroy",    "fd-open", "fd-give", "fd-close", "frame",   "actor-end", "witness"};
    const auto index = static_cast<std::size_t>(kind);
    return index < kNames.size() ? kNames[index] : "unknown event";
}

std::string_view toString(ActorKind kind) {
    switch (kind) {
        case ActorKind::GlContext:
            return "GL context";
        case ActorKind::VulkanQueue:
            return "Vulkan queue";
        case ActorKind::HostThread:
            return "host thread";
        case ActorKind::BridgeThread:
            return "bridge thread";
        case ActorKind::Process:
            return "process";
    }
    return "unknown actor";
}

std::string_view toString(SyncKind kind) {
    switch (kind) {
        case SyncKind::Timeline:
            return "timeline";
        case SyncKind::Binary:
            return "binary";
        case SyncKind::Fence:
            return "fence";
    }
    return "unknown sync";
}

std::string_view toString(Verdict verdict) {
    switch (verdict) {
        case Verdict::Fresh:
            return "fresh";
        case Verdict::Stale:
            return "stale";
        case Verdict::Torn:
            return "torn";
    }
    return "unknown verdict";
}

std::string_view toString(Severity severity) {
    switch (severity) {
        case Severity::Info:
            return "info";
        case Severity::Warning:
            return "warning";
        case Severity::Error:
            return "error";
    }
    return "unknown severity";
}

}  // namespace sluice::ledger
