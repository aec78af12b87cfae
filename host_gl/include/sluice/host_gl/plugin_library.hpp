// SPDX-License-Identifier: MIT
// Loading a renderer plugin.
#pragma once

#include <filesystem>
#include <memory>

#include "sluice/host_gl/isolation.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

class Isolation;

/// A loaded renderer library with a checked ABI. Move-only; unloading invalidates every renderer made from it.
class PluginLibrary {
  public:
    /// Fails with a message that names the path and the remedy when the file is missing, is not a shared object, lacks
    /// the entry symbol, serves another ABI major, or returns an incomplete table.
    [[nodiscard]] static Result<PluginLibrary> load(const std::filesystem::path& path);
    /// The plugin in processes of its own, one for each renderer; nothing of it is loaded here. Its table behaves as
    /// the plugin's would, on any number of threads, and says SLUICE_ERROR_DEVICE_LOST once the process has died or was
    /// killed because it hung.
    [[nodiscard]] static Result<PluginLibrary> isolated(const IsolationConfig& config);
    PluginLibrary(PluginLibrary&&) noexcept;
    PluginLibrary& operator=(PluginLibrary&&) noexcept;
    ~PluginLibrary();

    /// A copy of the plugin's table; functions that an older plugin's shorter table does not have are NULL. Those of
    /// ABI 1.0 are there. Stays where it is when the library is moved.
    [[nodiscard]] const SluiceRendererApi& api() const { return *api_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Of an isolated plugin's calls.
    [[nodiscard]] const CallLimits& limits() const { return limits_; }

  private:
    PluginLibrary() = default;
    void* handle_ = nullptr;                ///< null when isolated
    std::shared_ptr<Isolation> isolation_;  ///< null when loaded here
    std::unique_ptr<const SluiceRendererApi> api_;
    std::filesystem::path path_;
    CallLimits limits_;
};

}  // namespace sluice::host
