// SPDX-License-Identifier: MIT
// The FluidHost of a Session, in whichever context is current: made, given the scene, made again, let go of.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "api/session.hpp"
#include "context/profile.hpp"
#include "share/gl_errors.hpp"

namespace sluice::host {

namespace {

/// 2^this frames lie between tries to start at most: a minute or so.
constexpr std::uint32_t kLongestPause = 12;

/// Shader objects belong to whole share groups and are made once: a name that is not one of ours tells another context.
std::uint32_t makeWitness() {
    const GLuint witness = glCreateShader(GL_FRAGMENT_SHADER);
    const char* text = "// sluice was here";
    glShaderSource(witness, 1, &text, nullptr);
    return witness;
}

bool isWitness(std::uint32_t name) {
    if (name == 0 || glIsShader(name) != GL_TRUE) {
        return false;
    }
    std::array<char, 32> text{};
    glGetShaderSource(name, static_cast<GLsizei>(text.size()), nullptr, text.data());
    return std::string_view(text.data()) == "// sluice was here";
}

}  // namespace

void Session::drop() {
    const CurrentContext present = currentContext();
    if (present.kind != ContextKind::None && present == context_ && isWitness(witness_)) {
        const GlErrorScope errors;
        host_.reset();
        resolve_.clear();
        glDeleteShader(witness_);
    } else {
        const GlGone gone;
        host_.reset();
        resolve_.clear();
    }
    witness_ = 0;
    context_ = {};
    if (ledger_ != nullptr) {
        if (const Status status = ledger_->finish(ledger::End::Closed); !status) {
            log_(SLUICE_LOG_WARNING, status.error().message());
        }
        ledger_.reset();
    }
}

bool Session::reachable() const {
    return host_ != nullptr && currentContext() == context_ && isWitness(witness_);
}

Status Session::start(const CurrentContext& context, const Extent& extent) {
    drop();
    value_ = 0;
    drawn_ = 0;
    pending_ = false;
    if (Status status = startLedger(); !status) {
        return status;
    }
    FluidHostConfig config;
    config.ledger = ledger_.get();
    config.trace = trace_.get();
    config.width = extent[0];
    config.height = extent[1];
    config.timeline = timeline_;
    config.log = log_;
    if (timeline_ == SLUICE_TIMELINE_AUTO && context.kind != ContextKind::Egl &&
        !epoxy_has_gl_extension("GL_EXT_semaphore_fd")) {
        // The bridge needs a second context, and one of GLX would need the engine's Xlib to know of threads.
        config.timeline = SLUICE_TIMELINE_FINISH;
    }
    Result<std::unique_ptr<FluidHost>> made = FluidHost::create(*library_, config);
    if (!made) {
        return made.error();
    }
    host_ = std::move(made).value();
    context_ = context;
    witness_ = makeWitness();
    ++contexts_;
    return giveScene();
}

Status Session::giveScene() {
    if (const std::optional<SluiceEnvironment> environment = scene_.environment()) {
        if (Status status = host_->setEnvironment(&*environment); !status) {
            return status;
        }
    }
    const std::optional<SluiceSimulation> simulation = scene_.simulation();
    Status status = simulation ? host_->setSimulation(&*simulation) : Status{};
    return status && simulation && flow_ ? host_->setFlow(*flow_) : status;
}

Status Session::started(Status status) {
    if (status) {
        start_error_.reset();
        tries_ = 0;
    } else {
        start_error_ = status.error();
        to_go_ = 1U << std::min(tries_++, kLongestPause);
    }
    return status;
}

Status Session::settle(const std::optional<Extent>& wanted) {
    const CurrentContext context = currentContext();
    if (context.kind == ContextKind::None) {
        return noContext("Sluice");
    }
    if (Status status = awaited(); !status) {
        return status;
    }
    if (host_ == nullptr || context != context_ || !isWitness(witness_)) {
        // A start takes long, and one that fails would again: 1, 2, 4 ... frames lie between the tries.
        if (start_error_ && context == tried_in_ && to_go_ > 0) {
            --to_go_;
            return *start_error_;
        }
        const Status usable = checkContext();
        if (usable && host_ != nullptr) {
            log_(SLUICE_LOG_WARNING,
                 "another GL context is current: everything is made anew in it, and the fluid begins again");
        }
        const Extent extent = wanted              ? *wanted
                              : follows_drawable_ ? drawableExtent(context).value_or(Extent{64, 64})
                                                  : extent_;
        tries_ = context == tried_in_ ? tries_ : 0;
        tried_in_ = context;
        return started(usable ? start(context, extent) : usable);
    }
    // The renderer is there, and what it is to draw was refused: there is nothing to go on with until it is taken.
    if (start_error_) {
        if (to_go_ > 0) {
            --to_go_;
            return *start_error_;
        }
        if (Status status = started(giveScene()); !status) {
            return status;
        }
    }
    if (wanted && (host_->info().width != (*wanted)[0] || host_->info().height != (*wanted)[1])) {
        return host_->resize((*wanted)[0], (*wanted)[1]);
    }
    return {};
}

Status Session::resize(std::uint32_t width, std::uint32_t height) {
    if (width == 0 || height == 0 || width > SLUICE_MAX_EXTENT || height > SLUICE_MAX_EXTENT) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "sluice_resize",
                     fmt::format("expected 1..{} a side, found {}x{}", SLUICE_MAX_EXTENT, width, height),
                     "give the size of the drawable in pixels"};
    }
    extent_ = {width, height};
    follows_drawable_ = false;
    const GlErrorScope errors;
    return reachable() ? settle(extent_) : Status{};
}

}  // namespace sluice::host
