// SPDX-License-Identifier: MIT
// The functions that a plugin offers without a renderer.
#include <fmt/format.h>

#include <memory>
#include <utility>

#include "isolate/isolation.hpp"
#include "isolate/proxy.hpp"
#include "isolate/proxy_parts.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/capability_words.hpp"

namespace sluice::host::proxy {

namespace {

/// A process for a call that is given these two, of which it has been checked that they can be read.
Result<std::unique_ptr<RendererProcess>> processFor(Isolation& plugin, const SluiceHostServices* host,
                                                    const SluiceCreateInfo* info) {
    if (Status status = checkAbiStruct(host, "host"); !status) {
        return status.error();
    }
    if (Status status = checkAbiStruct(info, "info"); !status) {
        return status.error();
    }
    Result<std::unique_ptr<RendererProcess>> process = plugin.process();
    if (process) {
        process.value()->passTo(host);
    }
    return process;
}

}  // namespace

SluiceResult describe(Isolation& plugin, const SluiceHostServices* host, const SluiceCreateInfo* info,
                      SluiceRendererCapabilities* capabilities, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        Result<std::unique_ptr<RendererProcess>> process = processFor(plugin, host, info);
        if (!process) {
            return process.error();
        }
        isolate::Describe call;
        call.wants_trace = host->trace != nullptr ? 1 : 0;
        call.info = readAbiStruct(*info);
        Result<Reply> reply = process.value()->call(call, {}, "describe", {});
        return reply ? filledBy(reply.value().returned, capabilities, "capabilities") : Status{reply.error()};
    });
}

SluiceResult explain(Isolation& plugin, const SluiceSceneNeeds* needs, SluiceLineSink sink, void* user,
                     SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (Status status = checkAbiStruct(needs, "needs"); !status) {
            return status;
        }
        if (sink == nullptr) {
            return isNull("sink");
        }
        Result<std::unique_ptr<RendererProcess>> process = plugin.process();
        if (!process) {
            return process.error();
        }
        return simply(*process.value(), isolate::Explain{{}, readAbiStruct(*needs)}, "explain", {nullptr, sink, user});
    });
}

SluiceResult create(Isolation& plugin, const SluiceHostServices* host, const SluiceCreateInfo* info,
                    SluiceRenderer** renderer, SluiceError* error) {
    if (renderer != nullptr) {
        *renderer = nullptr;
    }
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        Result<std::unique_ptr<RendererProcess>> process = processFor(plugin, host, info);
        if (!process) {
            return process.error();
        }
        auto made = std::make_unique<Proxy>();
        made->process = std::move(process).value();
        made->services = readAbiStruct(*host);
        isolate::Create call;
        call.wants_trace = host->trace != nullptr ? 1 : 0;
        call.info = readAbiStruct(*info);
        if (Status status =
                simply(*made->process, call, fmt::format("create of {}x{}", call.info.width, call.info.height),
                       {&made->services, nullptr, nullptr});
            !status) {
            return status;
        }
        auto settled = sized<SluiceRendererInfo>();
        Result<Reply> reply = made->process->call(isolate::Info{}, {}, "info", {});
        if (Status status = reply ? filledBy(reply.value().returned, &settled, "info") : Status{reply.error()};
            !status) {
            return status;
        }
        made->by_cpu = settled.timeline == SLUICE_TIMELINE_BRIDGED || settled.timeline == SLUICE_TIMELINE_FINISH ||
                       settled.timeline == SLUICE_TIMELINE_UNSYNCHRONISED;
        made->max_particles = settled.capabilities.reserved[kMaxParticlesWord];
        *renderer = reinterpret_cast<SluiceRenderer*>(made.release());
        return {};
    });
}

SluiceResult probeFormat(Isolation& plugin, const SluiceHostServices* host, const SluiceCreateInfo* info,
                         std::uint32_t format, std::uint32_t width, std::uint32_t height, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        Result<std::unique_ptr<RendererProcess>> process = processFor(plugin, host, info);
        if (!process) {
            return process.error();
        }
        const SluiceHostServices services = readAbiStruct(*host);
        isolate::ProbeFormat call;
        call.wants_trace = services.trace != nullptr ? 1 : 0;
        call.format = format;
        call.width = width;
        call.height = height;
        call.info = readAbiStruct(*info);
        return simply(*process.value(), call, fmt::format("probe_format of format {}", format),
                      {&services, nullptr, nullptr});
    });
}

}  // namespace sluice::host::proxy
