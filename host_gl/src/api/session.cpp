// SPDX-License-Identifier: MIT
// How a Session is made: its plugin, in this process or in one of its own, and its ledger.
#include "api/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "api/places.hpp"
#include "share/gl_errors.hpp"
#include "sluice/defaults.hpp"

namespace sluice::host {

namespace {

/// A call that makes images and programs takes as long as it takes, on a machine that is busy too.
constexpr double kStartDeadline = 120.0;
constexpr double kFrameDeadline = 5.0;

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

}  // namespace sluice::host
