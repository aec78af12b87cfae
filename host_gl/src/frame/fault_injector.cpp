// SPDX-License-Identifier: MIT
#include "frame/fault_injector.hpp"

#include <fcntl.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "sluice/fd.hpp"

namespace sluice::host {

namespace {

constexpr const char* kThing = "injected fault";

}  // namespace

NoDescriptors::NoDescriptors() {
    const UniqueFd lowest{open("/dev/null", O_RDONLY | O_CLOEXEC)};
    rlimit limit{};
    if (lowest.get() < 0 || getrlimit(RLIMIT_NOFILE, &limit) != 0) {
        return;
    }
    const rlim_t usual = limit.rlim_cur;
    limit.rlim_cur = static_cast<rlim_t>(lowest.get());
    if (setrlimit(RLIMIT_NOFILE, &limit) == 0) {
        soft_limit_ = usual;
    }
}

NoDescriptors::~NoDescriptors() {
    rlimit limit{};
    if (soft_limit_ && getrlimit(RLIMIT_NOFILE, &limit) == 0) {
        limit.rlim_cur = *soft_limit_;
        (void)setrlimit(RLIMIT_NOFILE, &limit);
    }
}

std::uint64_t FaultInjector::valueOr(std::uint64_t usual) const {
    return fault_->value != 0 ? fault_->value : usual;
}

bool FaultInjector::contextLost() const {
    return is(HostFaultKind::ContextLost) && frame_ >= fault_->frame;
}

Status FaultInjector::submit(const Renderer& renderer, const SluiceFrame& frame) const {
    if (!fault_ || pending()) {
        return renderer.submit(frame);
    }
    const std::uint64_t since = frame_ - fault_->frame;
    switch (fault_->kind) {
        case HostFaultKind::DeviceLost:
        case HostFaultKind::OutOfFds:
        case HostFaultKind::OutOfMemory:
            if (since == 0) {
                return Error{SLUICE_ERROR_DEVICE_LOST, kThing, "submit_frame says that the device is lost", ""};
            }
            break;
        case HostFaultKind::PluginError:
            if (since < valueOr(1)) {
                // The renderer has to hear of the frame, or its numbers would have a gap.
                SluiceFrame refused = frame;
                refused.outputs = UINT32_MAX;
                (void)renderer.submit(refused);
                return Error{SLUICE_ERROR_INTERNAL, kThing, "submit_frame fails and says no more", ""};
            }
            break;
        case HostFaultKind::Hang:
            if (since == 0) {
                std::this_thread::sleep_for(std::chrono::milliseconds(valueOr(kHangMs)));
            }
            break;
        case HostFaultKind::ContextLost:
            break;
    }
    return renderer.submit(frame);
}

Status FaultInjector::inTry(std::optional<NoDescriptors>& taken) {
    if (!fault_ || pending()) {
        return {};
    }
    ++tries_;
    switch (fault_->kind) {
        case HostFaultKind::DeviceLost:
            if (tries_ <= fault_->value) {
                return Error{SLUICE_ERROR_DEVICE_LOST, kThing, "create says that the device is lost", ""};
            }
            break;
        case HostFaultKind::OutOfMemory:
            if (tries_ <= valueOr(1)) {
                return Error{SLUICE_ERROR_OUT_OF_MEMORY, kThing, "create finds no memory", ""};
            }
            break;
        case HostFaultKind::OutOfFds:
            if (tries_ <= valueOr(1)) {
                taken.emplace();
            }
            break;
        case HostFaultKind::PluginError:
        case HostFaultKind::Hang:
        case HostFaultKind::ContextLost:
            break;
    }
    return {};
}

}  // namespace sluice::host
