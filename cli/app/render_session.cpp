// SPDX-License-Identifier: MIT
#include "app/render_session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/interrupt.hpp"
#include "app/live_bodies.hpp"
#include "app/log.hpp"
#include "app/plugin_path.hpp"
#include "sluice/format.hpp"

namespace sluice::cli {
namespace {

constexpr std::size_t kTraceCapacity = 1U
                                       << 14U;  ///< events of one frame; a frame of first light makes about a hundred

/// How the plugin's log lines about the validation layer begin.
constexpr std::string_view kValidationPrefix = "validation: ";

constexpr std::uint64_t kLongestSetUpNs = 600'000'000'000;

/// The reason that the negotiation gives for `kind`; the renderer negotiated from the same capabilities.
std::string reasonFor(SluiceTimelineKind kind, const SluiceRendererInfo& info, const RenderOptions& options) {
    if (options.timeline != SLUICE_TIMELINE_AUTO) {
        return "asked for with --timeline";
    }
    NegotiationRequest request;
    request.outputs = layerOutputs(options);
    request.host_depth = options.depth_format;
    std::vector<Reason> considered;
    const auto agreement = negotiate(host::queryCapabilities(), info.capabilities, request, &considered);
    const std::vector<Reason>& reasons = agreement ? agreement.value().reasons : considered;
    std::string text;
    for (const Reason& reason : reasons) {
        if (reason.subject.starts_with("timeline ")) {
            text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", reason.subject.substr(9), reason.why);
            if (reason.accepted) {
                break;  // those after it were only second best
            }
        }
    }
    return text.empty() ? std::string(toString(kind)) : text;
}

bool ofProcess(const std::optional<host::FaultPlan>& fault) {
    return fault && host::ofProcess(fault->kind);
}

/// What the renderer's process is to do to itself. A call that would outlast the deadline hangs there, where it is
/// ended.
std::optional<host::FaultPlan> processFault(const RenderOptions& options) {
    if (ofProcess(options.fault)) {
        return options.fault;
    }
    const std::optional<host::HostFault>& fault = options.host_fault;
    if (!options.isolate || !fault || fault->kind != host::HostFaultKind::Hang) {
        return std::nullopt;
    }
    const std::uint64_t ms = fault->value != 0 ? fault->value : host::kHangMs;
    if (static_cast<double>(ms) < options.deadline_s * 1e3) {
        return std::nullopt;
    }
    return host::FaultPlan{host::FaultKind::StopRenderer, fault->frame};
}

Result<host::PluginLibrary> isolatePlugin(const RenderOptions& options) {
    Result<std::filesystem::path> path = findPlugin(options.plugin);
    if (!path) {
        return path.error();
    }
    host::IsolationConfig config;
    config.program = rendererProgram();
    config.plugin = std::move(path).value();
    config.fault = processFault(options);
    // Making images, programs and particles takes as long as it takes; a frame has its deadline.
    config.call_timeout_ns = std::max(kLongestSetUpNs, nanoseconds(options.deadline_s));
    config.frame_call_timeout_ns = nanoseconds(options.deadline_s);
    config.hurry = interrupted;
    return host::PluginLibrary::isolated(config);
}

}  // namespace

std::uint64_t nanoseconds(double seconds) {
    return static_cast<std::uint64_t>(seconds * 1e9);
}

std::uint32_t layerOutputs(const RenderOptions& options) {
    return options.layers.empty()
               ? 0
               : SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);
}

Result<RenderSession> createSession(const RenderInputs& inputs) {
    Result<host::GlContext> context = host::GlContext::create();
    if (!context) {
        return context.error();
    }
    if (Status current = context.value().makeCurrent(); !current) {
        return current.error();
    }
    if (const std::string note = host::glDeviceNote(); !note.empty()) {
        log(SLUICE_LOG_WARNING, note);
    }
    Result<host::Screen> screen = host::Screen::create(inputs.size.width, inputs.size.height);
    if (!screen) {
        return screen.error();
    }
    Result<host::LegacyEngine> engine = host::LegacyEngine::create(inputs.scene.engine);
    if (!engine) {
        return engine.error();
    }
    auto trace = std::make_unique<Trace>(kTraceCapacity);
    auto messages = std::make_unique<std::atomic<std::uint32_t>>(0);
    return RenderSession{std::move(trace),
                         std::move(context).value(),
                         std::move(screen).value(),
                         std::move(engine).value(),
                         std::move(messages),
                         nullptr,
                         std::nullopt,
                         nullptr,
                         {},
                         1,
                         inputs.live ? bodiesAtStart(*inputs.live) : std::vector<host::MovingBody>{}};
}

Status startLedger(RenderSession& session, const RenderOptions& options) {
    std::unique_ptr<ledger::LogWriter> log;
    if (!options.ledger_log.empty()) {
        Result<std::unique_ptr<ledger::LogWriter>> created = ledger::LogWriter::create(options.ledger_log);
        if (!created) {
            return created.error();
        }
        log = std::move(created).value();
    }
    if (options.ledger || log) {
        session.ledger = std::make_unique<ledger::LiveLedger>(ledger::LedgerOptions{}, std::move(log));
    }
    return {};
}

Status startFluid(RenderSession& session, const RenderInputs& inputs, const RenderOptions& options) {
    Result<host::PluginLibrary> library = options.isolate ? isolatePlugin(options) : loadPlugin(options.plugin);
    if (!library) {
        return library.error();
    }
    session.library.emplace(std::move(library).value());
    host::FluidHostConfig config;
    config.width = inputs.size.width;
    config.height = inputs.size.height;
    config.image_sets = options.image_sets;
    config.timeline = options.timeline;
    config.outputs = layerOutputs(options);
    config.host_depth = options.depth_format;
    config.validation = options.validation;
    config.trace = session.trace.get();
    config.ledger = session.ledger.get();
    config.fault = options.isolate && ofProcess(options.fault) ? std::nullopt : options.fault;
    config.host_fault = processFault(options) ? std::nullopt : options.host_fault;
    config.call_alarm_ns = nanoseconds(options.deadline_s);
    config.wait_timeout_ns = nanoseconds(options.deadline_s);
    config.log = [seen = session.validation_messages.get()](SluiceLogLevel level, std::string_view message) {
        if (message.starts_with(kValidationPrefix)) {
            // Whoever asked for validation wants to see every message, with --quiet too.
            seen->fetch_add(1, std::memory_order_relaxed);
            level = SLUICE_LOG_ERROR;
        }
        log(level, message);
    };
    Result<std::unique_ptr<host::FluidHost>> fluid = host::FluidHost::create(*session.library, config);
    if (!fluid) {
        Error error = fluid.error();
        if (options.isolate && error.code == SLUICE_ERROR_DEVICE_LOST) {
            error.remedy = fmt::format("{}x{} may be more than this device can make: give a smaller --size",
                                       config.width, config.height);
        }
        return error;
    }
    session.fluid = std::move(fluid).value();
    const SluiceRendererInfo& info = session.fluid->info();
    session.timeline_reason = reasonFor(static_cast<SluiceTimelineKind>(info.timeline), info, options);
    if (inputs.environment) {
        SluiceEnvironment map{};
        map.struct_size = sizeof(map);
        map.width = inputs.environment->width;
        map.height = inputs.environment->height;
        map.pixels = inputs.environment->pixels.data();
        if (Status status = session.fluid->setEnvironment(&map); !status) {
            session.fluid.reset();
            return status;
        }
    }
    if (inputs.live) {
        const SluiceSimulation simulation = inputs.live->view();
        if (Status status = session.fluid->setSimulation(&simulation); !status) {
            session.fluid.reset();
            return status;
        }
    }
    return {};
}

}  // namespace sluice::cli
