// SPDX-License-Identifier: MIT
// What the renderer may call, in the form of the C ABI.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string_view>

#include "share/image_table.hpp"
#include "sluice/ledger/share_feed.hpp"
#include "sluice/plugin.h"
#include "sluice/trace.hpp"

namespace sluice::host {

/// The services of one renderer. Its address is given to the renderer, so it neither moves nor copies. `log` may be
/// called on any thread and is called on one at a time.
class HostServices {
  public:
    /// With `shares` the renderer sends its events even when `trace` is nullptr, for it and for tellFeed(); it must
    /// outlive the services.
    HostServices(std::function<void(SluiceLogLevel, std::string_view)> log, Trace* trace,
                 ledger::ShareFeed* shares = nullptr);
    ~HostServices() = default;
    HostServices(const HostServices&) = delete;
    HostServices& operator=(const HostServices&) = delete;

    [[nodiscard]] const SluiceHostServices& table() const { return table_; }
    [[nodiscard]] ImageTable& images() { return images_; }
    [[nodiscard]] const ImageTable& images() const { return images_; }
    void log(SluiceLogLevel level, std::string_view message);
    /// From now on the renderer's events go to `feed` as well; nullptr: no more.
    void tellFeed(ledger::HandOffFeed* feed) { feed_ = feed; }

  private:
    std::function<void(SluiceLogLevel, std::string_view)> log_;
    Trace* trace_;
    ledger::ShareFeed* shares_;
    std::atomic<ledger::HandOffFeed*> feed_{nullptr};
    ImageTable images_;
    SluiceHostServices table_{};
    std::mutex log_mutex_;
    std::atomic<bool> short_event_told_ = false;

    static void logService(void* user, std::int32_t level, const char* message);
    static void traceService(void* user, const SluiceTraceEvent* event);
    static SluiceResult shareService(void* user, const SluiceImageExport* image, SluiceError* error);
    static void retireService(void* user, std::uint32_t role, std::uint32_t image_set);
    static SluiceResult canaryService(void* user, const SluiceImageExport* image, std::uint32_t seed,
                                      SluiceError* error);
};

}  // namespace sluice::host
