// SPDX-License-Identifier: MIT
// Makes a HostFault happen.
#pragma once

#include <cstdint>
#include <optional>

#include "frame/renderer.hpp"
#include "sluice/host_gl/host_fault.hpp"
#include "sluice/result.hpp"

namespace sluice::host {

/// While it lives no descriptor can be opened: the soft limit of the process is its lowest free number. Best effort.
class NoDescriptors {
  public:
    NoDescriptors();
    NoDescriptors(const NoDescriptors&) = delete;
    NoDescriptors& operator=(const NoDescriptors&) = delete;
    ~NoDescriptors();

  private:
    std::optional<std::uint64_t> soft_limit_;  ///< the one to go back to
};

/// Counts the host's frames and says what goes wrong in them. Without a fault nothing does. GL thread.
class FaultInjector {
  public:
    explicit FaultInjector(const std::optional<HostFault>& fault) : fault_(fault) {}

    void frameBegins() { ++frame_; }
    [[nodiscard]] bool contextLost() const;
    /// The frame of the fault has not come yet.
    [[nodiscard]] bool pending() const { return fault_ && frame_ < fault_->frame; }
    /// submit_frame of `renderer`, or what is said in its place.
    [[nodiscard]] Status submit(const Renderer& renderer, const SluiceFrame& frame) const;
    /// Before a renderer is tried: what the try says instead, if anything. Then the descriptors are gone, or not,
    /// for as long as `taken` lives.
    [[nodiscard]] Status inTry(std::optional<NoDescriptors>& taken);

  private:
    [[nodiscard]] bool is(HostFaultKind kind) const { return fault_ && fault_->kind == kind; }
    [[nodiscard]] std::uint64_t valueOr(std::uint64_t usual) const;

    std::optional<HostFault> fault_;
    std::uint64_t frame_ = 0;
    std::uint64_t tries_ = 0;
};

}  // namespace sluice::host
