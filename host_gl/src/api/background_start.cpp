// SPDX-License-Identifier: MIT
#include "api/background_start.hpp"

#include <exception>
#include <system_error>
#include <utility>

#include "sluice/abi_sizes.hpp"
#include "sluice/blocked_signals.hpp"
#include "sluice/plugin.h"

namespace sluice::host {

namespace {

/// What a start would hang in: the drivers that are looked through for a device. Which one is found, or that none is,
/// is the start's own business.
Status rehearse(const PluginLibrary& library) {
    const auto host = sized<SluiceHostServices>();
    auto info = sized<SluiceCreateInfo>();
    info.width = info.height = 64;
    info.image_sets = 1;
    info.timeline = SLUICE_TIMELINE_FINISH;
    auto found = sized<SluiceRendererCapabilities>();
    auto error = sized<SluiceError>();
    if (library.api().describe(&host, &info, &found, &error) != SLUICE_ERROR_DEVICE_LOST) {
        return {};
    }
    return Error{SLUICE_ERROR_DEVICE_LOST, "start of the renderer", &error.message[0], ""};
}

}  // namespace

Result<std::unique_ptr<BackgroundStart>> BackgroundStart::begin(IsolationConfig config) {
    std::unique_ptr<BackgroundStart> start(new BackgroundStart);
    config.hurry = [hurry = start->hurry_] { return hurry->load(); };
    try {
        const BlockedSignals quiet;
        start->thread_ = std::thread([raw = start.get(), config = std::move(config)] { raw->run(config); });
    } catch (const std::system_error& failed) {
        return Error{SLUICE_ERROR_OUT_OF_MEMORY, "thread that starts the renderer", failed.what(), ""};
    }
    return start;
}

BackgroundStart::~BackgroundStart() {
    if (thread_.joinable()) {
        hurry_->store(true);
        thread_.join();
    }
}

void BackgroundStart::run(const IsolationConfig& config) {
    Result<PluginLibrary> made = Error{SLUICE_ERROR_OUT_OF_MEMORY, "start of the renderer", "out of memory", ""};
    try {
        made = PluginLibrary::isolated(config);
        if (Status ready = made ? rehearse(made.value()) : Status{}; !ready) {
            made = ready.error();
        }
    } catch (const std::exception&) {  // memory, which is what `made` says
    }
    const std::lock_guard lock(mutex_);
    made_ = std::move(made);
}

std::optional<Result<PluginLibrary>> BackgroundStart::take() {
    {
        const std::lock_guard lock(mutex_);
        if (!made_) {
            return std::nullopt;
        }
    }
    thread_.join();
    return std::exchange(made_, std::nullopt);
}

}  // namespace sluice::host
