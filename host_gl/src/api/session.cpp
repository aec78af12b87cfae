// SPDX-License-Identifier: MIT
#include "api/session.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "api/places.hpp"
#include "context/profile.hpp"
#include "share/gl_errors.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/defaults.hpp"

namespace sluice::host {

namespace {

/// More than this the fluid does not make good after a pause: it would take the time of many frames.
constexpr double kLongestStride = 0.1;

/// A call that makes images and programs takes as long as it takes, on a machine that is busy too.
constexpr double kStartDeadline = 120.0;
constexpr double kFrameDeadline = 5.0;
/// 2^this frames lie between tries to start at most: a minute or so.
constexpr std::uint32_t kLongestPause = 12;

Error noContext(const char* call) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, call, "no EGL or GLX context is current on this thread",
            "call it on the thread that draws, after the context was made current"};
}

Status checkContext() {
    if (!epoxy_is_desktop_gl() || epoxy_gl_version() < 21) {
        const int version = epoxy_gl_version();
        return Error{SLUICE_ERROR_UNSUPPORTED, "OpenGL context",
                     fmt::format("found {}{}.{}", epoxy_is_desktop_gl() ? "" : "ES ", version / 10, version % 10),
                     "desktop OpenGL with 2.1 or newer in GL_VERSION is needed"};
    }
    if (epoxy_gl_version() < 30 && !epoxy_has_gl_extension("GL_ARB_framebuffer_object")) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "OpenGL context", "GL_ARB_framebuffer_object is missing",
                     "update the GL driver"};
    }
    return {};
}

/// At most an hour.
std::uint64_t nanoseconds(double seconds, double otherwise) {
    return static_cast<std::uint64_t>((seconds > 0.0 ? std::min(seconds, 3600.0) : otherwise) * 1e9);
}

Result<IsolationConfig> isolationOf(const SluiceOptions& options, std::filesystem::path plugin,
                                    const std::filesystem::path& folder) {
    Result<std::filesystem::path> program = rendererPlace(options.renderer_program, folder);
    if (!program) {
        return program.error();
    }
    IsolationConfig config;
    config.program = std::move(program).value();
    config.plugin = std::move(plugin);
    config.call_timeout_ns = nanoseconds(options.start_deadline, kStartDeadline);
    config.frame_call_timeout_ns = nanoseconds(options.frame_deadline, kFrameDeadline);
    config.detached = true;  // an engine that waits for its children knows nothing of ours
    return config;
}

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

std::optional<Matrix> kept(const float* matrix) {
    if (matrix == nullptr) {
        return std::nullopt;
    }
    Matrix copy{};
    std::copy_n(matrix, copy.size(), copy.begin());
    return copy;
}

}  // namespace

Result<std::unique_ptr<Session>> Session::create(const SluiceOptions& options) {
    const CurrentContext context = currentContext();
    if (context.kind == ContextKind::None) {
        return noContext("sluice_create");
    }
    const GlErrorScope errors;
    if (Status status = checkContext(); !status) {
        return status.error();
    }
    const std::filesystem::path folder = libraryFolder();
    Result<std::filesystem::path> plugin = pluginPlace(options.plugin, folder);
    if (!plugin) {
        return plugin.error();
    }
    std::unique_ptr<Session> session(new Session(options, logSink(options)));
    session->look_ = defaultFluid();
    session->sky_ = defaultSky();
    if (options.process == SLUICE_PROCESS_SAME) {
        Result<PluginLibrary> library = PluginLibrary::load(plugin.value());
        if (!library) {
            return library.error();
        }
        session->library_.emplace(std::move(library).value());
    } else if (Status status = session->isolate(options, std::move(plugin).value(), folder); !status) {
        return status.error();
    }
    if (session->starting_ != nullptr) {
        return session;
    }
    // Whatever is wrong with the machine is to be known now and not in some frame. Without a size there is none to wait
    // for either: any will do, and the first frame brings the right one.
    const Extent extent =
        session->follows_drawable_ ? drawableExtent(context).value_or(Extent{64, 64}) : session->extent_;
    if (Status status = session->start(context, extent); !status) {
        return status.error();
    }
    return session;
}

Status Session::isolate(const SluiceOptions& options, std::filesystem::path plugin,
                        const std::filesystem::path& folder) {
    Result<IsolationConfig> config = isolationOf(options, std::move(plugin), folder);
    if (!config) {
        return config.error();
    }
    if (options.start_in_background != 0) {
        Result<std::unique_ptr<BackgroundStart>> begun = BackgroundStart::begin(std::move(config).value());
        if (!begun) {
            return begun.error();
        }
        starting_ = std::move(begun).value();
        return {};
    }
    Result<PluginLibrary> library = PluginLibrary::isolated(config.value());
    if (!library) {
        return library.error();
    }
    library_.emplace(std::move(library).value());
    return {};
}

Session::~Session() {
    drop();
}

Status Session::awaited() {
    if (std::optional<Result<PluginLibrary>> made = starting_ != nullptr ? starting_->take() : std::nullopt; made) {
        starting_.reset();
        if (*made) {
            library_.emplace(std::move(*made).value());
        } else {
            not_started_ = made->error();
        }
    }
    return notThere();
}

Status Session::notThere() const {
    if (library_) {
        return {};
    }
    return not_started_ ? *not_started_ : Error{SLUICE_NOT_READY, "renderer", "its process is being started", ""};
}

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

std::string Session::ledgerLog(const char* asked) {
    if (asked != nullptr) {
        return asked;
    }
    const char* variable = std::getenv("SLUICE_LEDGER_LOG");
    return variable != nullptr ? variable : "";
}

Status Session::startLedger() {
    if (ledger_log_.empty()) {
        return {};
    }
    Result<std::unique_ptr<ledger::LogWriter>> log = ledger::LogWriter::create(std::exchange(ledger_log_, {}));
    if (!log) {
        return log.error();
    }
    ledger_ = std::make_unique<ledger::LiveLedger>(ledger::LedgerOptions{}, std::move(log).value());
    return {};
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

Status Session::setCamera(const float* view, const float* projection) {
    view_ = kept(view);
    projection_ = kept(projection);
    if (view_ && projection_) {
        return {};
    }
    view_.reset();
    projection_.reset();
    if (view != nullptr || projection != nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "camera", "one of its matrices is NULL and the other is not",
                     "give both, or neither"};
    }
    if (currentContext().kind == ContextKind::None) {
        return noContext("camera");
    }
    const GlErrorScope errors;
    const Result<std::array<Matrix, 2>> found = matricesOfContext();
    if (!found) {
        return found.error();
    }
    view_ = found.value()[0];
    projection_ = found.value()[1];
    return {};
}

Status Session::beginFrame(const float* view, const float* projection, double time) {
    in_frame_ = true;
    begun_in_ = currentContext();
    begin_error_.reset();
    const double passed = clock_ && std::isfinite(time) ? time - *clock_ : 0.0;
    if (std::isfinite(time)) {
        clock_ = time;
    }
    began_active_ = active();
    if (!began_active_) {
        return {};
    }
    owed_ = std::clamp(owed_ + std::max(passed, 0.0), 0.0, kLongestStride);
    Status camera = setCamera(view, projection);
    if (Status status = flowOn(); !status) {
        begin_error_ = status.error();
        return status;
    }
    return camera;
}

Status Session::flowOn() {
    if (begun_in_.kind == ContextKind::None) {
        return noContext("sluice_begin_frame");
    }
    const GlErrorScope errors;
    range_at_begin_ = depthRange();
    if (Status status = settle(std::nullopt); !status) {
        return status;
    }
    // What has not been drawn yet is not left behind: an engine that skips frames must not pile up steps.
    if (!pending_) {
        Status status = host_->simulate(value_ + 1, value_ == 0 ? 0.0 : owed_);
        if (!status && !host_->recovering()) {
            return status;
        }
        // The number is spent even where a renderer was lost over it: the next one begins with it, in this very frame
        // perhaps. The log has that; whether the frame gets fluid sluice_end_frame says.
        ++value_;
        owed_ = 0.0;
        pending_ = true;
    }
    return {};
}

}  // namespace sluice::host
