// SPDX-License-Identifier: MIT
// The host as a renderer in another process sees it: the services of sluice/plugin.h over a channel.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "sluice/isolate/channel.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::isolate {

/// A host that takes no messages for so long is given up; what it was to be told is lost.
inline constexpr std::uint64_t kSendNs = 10'000'000'000;

[[nodiscard]] Error breachOfHost(std::string detail);

/// log and trace may come on any thread; everything else on that of the calls.
class HostEnd {
  public:
    explicit HostEnd(const Channel& channel) : channel_(channel) {}
    HostEnd(const HostEnd&) = delete;
    HostEnd& operator=(const HostEnd&) = delete;
    ~HostEnd() = default;

    /// What the renderer is given; this must outlive it.
    [[nodiscard]] SluiceHostServices services(std::uint32_t wants_trace);
    /// The call during which the renderer may ask for something now.
    void serveCall(std::uint64_t call) { call_ = call; }
    /// One way. A host that is gone is noticed by the next receive.
    void tell(const Message& message) const { (void)channel_.send(message, 0, {}, kSendNs); }
    /// Events reach the host before the end of the call that made them.
    void flushTrace();
    /// Set once the host has answered with something else.
    [[nodiscard]] const std::optional<Error>& breach() const { return breach_; }

  private:
    /// Sends it and waits for the host's Answer.
    [[nodiscard]] Status ask(const Message& message, std::span<const int> fds);
    /// The same with an image's memory, which is the host's from then on if it has taken it.
    [[nodiscard]] Status give(const SluiceImageExport& image, const Message& message);
    void trace(const SluiceTraceEvent* event);
    void sendTrace();

    const Channel& channel_;
    std::uint64_t call_ = 0;
    std::optional<Error> breach_;
    std::mutex trace_mutex_;
    TraceEvents trace_;
};

}  // namespace sluice::isolate
