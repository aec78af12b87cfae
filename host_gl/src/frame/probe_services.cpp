// SPDX-License-Identifier: MIT
#include <utility>

#include "frame/host_services.hpp"
#include "sluice/host_gl/fluid_host.hpp"

namespace sluice::host {

struct ProbeServices::Impl {
    HostServices services;
};

ProbeServices::ProbeServices(std::function<void(SluiceLogLevel, std::string_view)> log)
    : impl_(new Impl{HostServices(std::move(log), nullptr)}) {}

ProbeServices::~ProbeServices() = default;

const SluiceHostServices& ProbeServices::services() const {
    return impl_->services.table();
}

}  // namespace sluice::host
