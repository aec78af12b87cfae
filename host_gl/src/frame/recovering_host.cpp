// SPDX-License-Identifier: MIT
// From one renderer to the next.
#include "frame/recovering_host.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "frame/descriptor_note.hpp"
#include "sluice/capability_words.hpp"
#include "sluice/ledger/live.hpp"
#include "sluice/trace.hpp"

namespace sluice::host {

namespace {

std::string frames(std::uint64_t count) {
    return fmt::format("{} frame{}", count, count == 1 ? "" : "s");
}

}  // namespace

Status RecoveringHost::begin() {
    FluidHostConfig config = config_;
    if (config.fault && base_ > 0) {
        config.fault->frame -= std::min(config.fault->frame, base_);
        if (config.fault->frame == 0) {
            config.fault.reset();
        }
    }
    if (config.ledger != nullptr) {
        config.ledger->rendererBegins({renderers_ + 1, base_});
    }
    auto life = std::make_unique<RendererLife>(config, watch_, faults_);
    if (Status status = withDescriptorNote(life->start(library_)); !status) {
        return status;
    }
    info_ = life->info();
    life_ = std::move(life);
    ++renderers_;
    return {};
}

Status RecoveringHost::beginWithScene() {
    if (Status status = begin(); !status) {
        return status;
    }
    if (const auto environment = scene_.environment()) {
        Status status = life_->setEnvironment(&*environment);
        if (refused(status)) {
            scene_.forgetEnvironment();
            drop("environment", status.error());
        } else if (!status) {
            return status;
        }
    }
    if (const auto particles = scene_.particles()) {
        Status status = life_->setParticles(*particles);
        if (refused(status)) {
            scene_.forgetParticles();
            drop("particles", status.error());
        } else if (!status) {
            return status;
        }
    }
    if (const auto simulation = scene_.simulation()) {
        Status status = simulateAgain(*simulation);
        if (refused(status)) {
            scene_.keep(static_cast<const SluiceSimulation*>(nullptr));
            simulation_dropped_ = true;
            drop("simulation", status.error());
        } else if (!status) {
            return status;
        }
    }
    return {};
}

void RecoveringHost::drop(const char* part, const Error& refusal) {
    log(SLUICE_LOG_WARNING,
        fmt::format("renderer: the {} set last: dropped, the new renderer refuses it: {}", part, refusal.message()));
}

Status RecoveringHost::revive() {
    switch (recovery_.nextFrame()) {
        case Recovery::Step::None:
            return {};
        case Recovery::Step::Wait:
        case Recovery::Step::GivenUp:
            return whileDown("submit");
        case Recovery::Step::Try:
            break;
    }
    return tryAgain();
}

Status RecoveringHost::tryAgain() {
    if (life_) {
        base_ += life_->numbersSpent();
        life_.reset();
    }
    const std::uint64_t began = monotonicNanoseconds();
    const Status status = withoutThrowing([this]() -> Status {
        std::optional<NoDescriptors> taken;
        Status injected = faults_.inTry(taken);
        Status made = injected ? beginWithScene() : std::move(injected);
        if (!made && taken) {
            Error error = made.error();
            error.detail += ", for the injected fault has lowered their limit";
            error.remedy.clear();
            return error;
        }
        return made;
    });
    if (!status) {
        life_.reset();
    }
    recovery_.tried(status.ok());
    const auto ms = [](std::uint64_t from) { return static_cast<double>(monotonicNanoseconds() - from) * 1e-6; };
    if (status) {
        // What came as it was announced is no warning.
        log(try_failed_ ? SLUICE_LOG_WARNING : SLUICE_LOG_INFO,
            fmt::format("renderer: here again after {} without fluid and {:.0f} ms, of which its creation took {:.0f} "
                        "ms (try {} of {})",
                        frames(without_fluid_ - std::min<std::uint64_t>(without_fluid_, 1)), ms(down_since_ns_),
                        ms(began), recovery_.tries(), config_.recovery.attempts));
        return {};
    }
    try_failed_ = true;
    cause_ = status.error().message();
    const std::string next = recovery_.givenUp() ? std::string("given up; destroy the FluidHost and create it again")
                                                 : fmt::format("the next one in {}", frames(recovery_.framesToGo()));
    log(SLUICE_LOG_WARNING, fmt::format("renderer: try {} of {} failed, {}: {}", recovery_.tries(),
                                        config_.recovery.attempts, next, cause_));
    return whileDown("submit");
}

Status RecoveringHost::judged(Status status) {
    if (!status && life_ && life_->fault()) {
        fault(*life_->fault());
    }
    return status;
}

void RecoveringHost::fault(const Error& cause) {
    if (!recovers() || !life_ || recovery_.down()) {
        return;
    }
    recovery_.fault();
    fault_told_ = false;
    down_since_ns_ = monotonicNanoseconds();
    try_failed_ = false;
    cause_ = Error{cause.code, cause.thing, cause.detail, {}}.message();  // the remedy is what is done here
    log(SLUICE_LOG_ERROR,
        recovery_.givenUp()
            ? fmt::format("renderer: useless once more after {} tries, given up: {}", recovery_.tries(), cause_)
            : fmt::format("renderer: useless from frame {} on, created again within {} (try {} of {}), until then the "
                          "host's frames go on without fluid: {}",
                          last_fluid_ + 1, frames(recovery_.framesToGo()), recovery_.tries() + 1,
                          config_.recovery.attempts, cause_));
    fault_told_ = true;
}

Status RecoveringHost::checkFits(const SluiceParticles& particles) const {
    Status status = checkPart(particles);
    const std::uint32_t most = info_.capabilities.reserved[kMaxParticlesWord];
    if (status && most != 0 && particles.count > most) {
        // Kept, they would take the place of those that it had accepted, and go with it when it comes back.
        return Error{SLUICE_ERROR_UNSUPPORTED, "particles",
                     fmt::format("this device takes at most {}, found {}", most, particles.count), "use fewer"};
    }
    return status;
}

Error RecoveringHost::whileDown(const char* call) const {
    return Error{SLUICE_ERROR_DEVICE_LOST, call, "there is no renderer: " + cause_,
                 recovery_.givenUp() ? "destroy the FluidHost and create it again" : "it is created again"};
}

void RecoveringHost::log(SluiceLogLevel level, const std::string& text) {
    if (config_.log) {
        config_.log(level, text);
    }
}

}  // namespace sluice::host
