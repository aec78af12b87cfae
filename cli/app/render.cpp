// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <new>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/log.hpp"
#include "app/output_folders.hpp"
#include "app/outputs.hpp"
#include "app/render_files.hpp"
#include "app/render_inputs.hpp"
#include "app/render_run.hpp"
#include "image/files.hpp"

namespace sluice::cli {
namespace {

/// The ledger's verdict, once nobody can signal any more.
int finishLedger(Run& run, bool handed_over, int code) {
    ledger::LiveLedger* ledger = run.session.ledger.get();
    if (ledger == nullptr) {
        return code;
    }
    if (const Status status = ledger->finish(ledger::End::Closed); !status) {
        logError(status.error());
        code = kExitInternal;
    } else if (!run.options.ledger_log.empty()) {
        run.summary.files.push_back(run.options.ledger_log);
    }
    if (!handed_over) {
        ledger->leaveUnchecked({1, "no frame was handed to a renderer"});
    }
    run.summary.ledger = LedgerSummary{ledger->eventsSeen(), ledger->memoryBytes(), ledger->findingsDropped(),
                                       ledger->findings(), ledger->unchecked()};
    return code;
}

/// The renderer's shut-down belongs to the trace too, so the trace is written after it.
int finish(Run& run, int code) {
    const bool handed_over = run.session.fluid && run.session.fluid->frame() > 0;
    run.session.fluid.reset();
    code = finishLedger(run, handed_over, code);
    std::vector<TraceRecord> last = run.session.trace->drain();
    RunSummary& s = run.summary;
    s.validation_messages = std::max(s.validation_messages, run.session.validation_messages->load());
    if (s.validation_messages > 0) {
        s.problems.push_back(fmt::format("the Vulkan validation layer had {} messages; they are in the log above",
                                         s.validation_messages));
        s.exit_code = kExitNoFluid;
    }
    run.summary.trace_dropped = run.session.trace->dropped();
    if (!run.options.trace.empty()) {
        run.records.insert(run.records.end(), last.begin(), last.end());
        if (const Status status = writeChromeTraceFile(run.options.trace, run.records, run.summary.trace_dropped);
            !status) {
            logError(status.error());
            code = kExitInternal;
        } else {
            run.summary.files.push_back(run.options.trace);
        }
    }
    run.summary.passes = run.passes.rows();
    if (code != kExitOk) {
        run.summary.exit_code = code;
    }
    if (run.options.json) {
        fmt::print("{}\n", summaryJson(run.summary).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    } else if (!run.options.quiet) {
        fmt::print("{}", summaryText(run.summary));
    }
    return run.summary.exit_code;
}

int renderChecked(const RenderOptions& options, RenderInputs inputs) {
    // With auto the timeline is known once the renderer is, and FluidHost asks the same.
    const bool checked_here = options.fault && !(options.isolate && host::ofProcess(options.fault->kind));
    if (const Status status = checked_here ? host::checkFault(*options.fault, options.timeline) : Status{}; !status) {
        logError(status.error());
        return kExitUsage;
    }
    if (const Status status = checkOutputs(options, inputs.frames); !status) {
        logError(status.error());
        return kExitUsage;
    }
    if (const Status status = checkRoles(options, inputs); !status) {
        logError(status.error());
        return kExitUsage;
    }
    if (const Status status = imageFilesPossible(); !status) {
        logError(status.error());
        return kExitInternal;
    }
    OutputFolders folders;
    if (const Status status = prepareOutputs(folders, options, inputs.frames); !status) {
        logError(status.error());
        return kExitInternal;
    }
    if (const Status status = checkInputs(inputs, !options.quiet); !status) {
        logError(status.error());
        return kExitBadInput;
    }
    if (interrupted()) {
        return kExitInterrupted;
    }
    Result<RenderSession> session = createSession(inputs);
    if (!session) {
        logError(session.error());
        return kExitInternal;
    }
    if (const Status status = startLedger(session.value(), options); !status) {
        logError(status.error());
        return kExitInternal;
    }
    Run run{options, std::move(inputs), std::move(session).value(), {}, {}, {}, {}, {}, {}, 0};
    if (run.inputs.live) {
        run.live.emplace(*run.inputs.live, run.inputs.frames);
        run.summary.particles = run.inputs.live->count();
        run.summary.radius = run.inputs.live->settings.radius;
        log(SLUICE_LOG_INFO, sayLive(options.scene, *run.inputs.live));
    }
    run.summary.scene = options.scene;
    run.summary.frames = run.inputs.frames;
    run.summary.size = run.inputs.size;
    return finish(run, renderAll(run));
}

}  // namespace

int render(const RenderOptions& asked) {
    watchForInterrupt();
    Result<RenderInputs> inputs = readScene(asked);
    if (!inputs) {
        logError(inputs.error());
        return kExitBadInput;
    }
    RenderOptions options = asked;
    options.layers = asked.layers.empty() ? "" : numberedPattern(asked.layers, inputs.value().frames);
    if (options.layers != asked.layers) {
        log(SLUICE_LOG_WARNING,
            fmt::format("--layers {}: several frames, so they are numbered: {}", asked.layers, options.layers));
    }
    const scene::Size size = inputs.value().size;
    try {
        return renderChecked(options, std::move(inputs).value());
    } catch (const std::bad_alloc&) {
        logError(noMemory(size, !options.layers.empty()));
        return kExitInternal;
    }
}

}  // namespace sluice::cli
