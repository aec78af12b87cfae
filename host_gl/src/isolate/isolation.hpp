// SPDX-License-Identifier: MIT
// An isolated plugin as the library that PluginLibrary is of: it starts a process for each renderer.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "isolate/renderer_process.hpp"
#include "sluice/host_gl/isolation.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

/// Its table answers as the plugin's would, from another process. Neither moves nor copies: the table leads here.
class Isolation {
  public:
    /// Starts the first process, which says what the plugin is and waits for the first call.
    [[nodiscard]] static Result<std::shared_ptr<Isolation>> start(const IsolationConfig& config);
    Isolation(const Isolation&) = delete;
    Isolation& operator=(const Isolation&) = delete;
    ~Isolation();

    [[nodiscard]] const SluiceRendererApi& table() const { return table_; }
    /// The process that waits, if it still lives, or a new one. Any thread.
    [[nodiscard]] Result<std::unique_ptr<RendererProcess>> process();

  private:
    explicit Isolation(IsolationConfig config) : config_(std::move(config)) {}

    std::mutex mutex_;  ///< of the two that follow
    IsolationConfig config_;
    std::unique_ptr<RendererProcess> waiting_;
    isolate::Welcome plugin_;
    SluiceRendererApi table_{};
    std::size_t place_ = SIZE_MAX;  ///< in the table of isolation.cpp
};

}  // namespace sluice::host
