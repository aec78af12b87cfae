// SPDX-License-Identifier: MIT
// An isolated plugin made ready on a thread of its own, while the engine draws.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "sluice/host_gl/isolation.hpp"
#include "sluice/host_gl/plugin_library.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// Loads it, and has it look for its device: whatever of that hangs is not asked for by the thread that draws.
class BackgroundStart {
  public:
    [[nodiscard]] static Result<std::unique_ptr<BackgroundStart>> begin(IsolationConfig config);
    BackgroundStart(const BackgroundStart&) = delete;
    BackgroundStart& operator=(const BackgroundStart&) = delete;
    /// Waits two seconds for one that hangs.
    ~BackgroundStart();

    /// Nothing while it takes its time; once.
    [[nodiscard]] std::optional<Result<PluginLibrary>> take();

  private:
    BackgroundStart() = default;
    void run(const IsolationConfig& config);

    /// Asked by every call of the plugin's, which may outlive this.
    std::shared_ptr<std::atomic<bool>> hurry_ = std::make_shared<std::atomic<bool>>(false);
    std::mutex mutex_;
    std::optional<Result<PluginLibrary>> made_;
    std::thread thread_;
};

}  // namespace sluice::host
