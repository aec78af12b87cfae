// SPDX-License-Identifier: MIT
// The C ABI of sluice/plugin.h: checks arguments, translates Results, keeps exceptions in. No other logic.
#include <fmt/format.h>

#include <utility>

#include "plugin/api.hpp"
#include "plugin/arguments.hpp"
#include "plugin/prove.hpp"
#include "plugin/renderer.hpp"
#include "plugin/simulation_api.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {
namespace {

Error isNull(const char* name) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name, "it is NULL", ""};
}

/// The device for a call that leaves nothing behind. `services` must outlive it; `info` has passed checkCreateHeader.
Result<std::unique_ptr<Device>> deviceFor(const SluiceHostServices& services, const SluiceCreateInfo& info) {
    const SluiceCreateInfo known = readCreateInfo(info);
    DeviceRequest request;
    request.host = known.host;
    request.validation = known.validation != 0;
    request.services = &services;
    return Device::create(request);
}

SluiceResult describe(const SluiceHostServices* host, const SluiceCreateInfo* info,
                      SluiceRendererCapabilities* capabilities, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (Status status = checkAbiStruct(capabilities, "capabilities"); !status) {
            return status;
        }
        if (Status status = checkServices(host); !status) {
            return status;
        }
        if (Status status = checkCreateHeader(info); !status) {
            return status;
        }
        const SluiceHostServices services = readAbiStruct(*host);
        Result<std::unique_ptr<Device>> device = deviceFor(services, *info);
        if (!device) {
            return device.error();
        }
        return writeAbiStruct(capabilities, device.value()->capabilities, "capabilities");
    });
}

SluiceResult explainNeeds(const SluiceSceneNeeds* needs, SluiceLineSink sink, void* sink_user, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (Status status = checkNeeds(needs); !status) {
            return status;
        }
        if (sink == nullptr) {
            return isNull("sink");
        }
        Result<Plan> plan = makePlan(readAbiStruct(*needs));
        if (!plan) {
            return plan.error();
        }
        for (const std::string& line : sluice::vk::explain(plan.value())) {
            sink(sink_user, line.c_str());
        }
        return {};
    });
}

SluiceResult create(const SluiceHostServices* host, const SluiceCreateInfo* info, SluiceRenderer** renderer,
                    SluiceError* error) {
    if (renderer != nullptr) {
        *renderer = nullptr;
    }
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkCreateInfo(host, info); !status) {
            return status;
        }
        Result<std::unique_ptr<SluiceRenderer>> made =
            SluiceRenderer::create(readAbiStruct(*host), readCreateInfo(*info));
        if (!made) {
            return made.error();
        }
        *renderer = std::move(made).value().release();
        return {};
    });
}

SluiceResult info(SluiceRenderer* renderer, SluiceRendererInfo* out) {
    return guarded(nullptr, [&]() -> Status {
        return renderer == nullptr ? isNull("renderer") : writeAbiStruct(out, renderer->info(), "info");
    });
}

SluiceResult resize(SluiceRenderer* renderer, std::uint32_t width, std::uint32_t height, SluiceError* error) {
    return guarded(
        error, [&]() -> Status { return renderer == nullptr ? isNull("renderer") : renderer->resize(width, height); });
}

SluiceResult setParticles(SluiceRenderer* renderer, const SluiceParticles* particles, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkParticles(particles); !status) {
            return status;
        }
        return renderer->setParticles(readAbiStruct(*particles));
    });
}

SluiceResult setEnvironment(SluiceRenderer* renderer, const SluiceEnvironment* environment, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkEnvironment(environment); !status) {
            return status;
        }
        if (environment == nullptr) {
            return renderer->setEnvironment(nullptr);
        }
        const SluiceEnvironment map = readAbiStruct(*environment);
        return renderer->setEnvironment(&map);
    });
}

SluiceResult submitFrame(SluiceRenderer* renderer, const SluiceFrame* frame, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(frame, "frame"); !status) {
            return status;
        }
        return renderer->submitFrame(readAbiStruct(*frame));
    });
}

SluiceResult poll(SluiceRenderer* renderer, std::uint64_t frame, SluiceFrameStats* stats) {
    SluiceResult answer = SLUICE_OK;
    const SluiceResult failure = guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(stats, "stats"); !status) {
            return status;
        }
        SluiceFrameStats found{};
        answer = renderer->poll(frame, found);
        return answer == SLUICE_OK ? writeAbiStruct(stats, found, "stats") : Status{};
    });
    return failure != SLUICE_OK ? failure : answer;
}

SluiceResult timelineSignal(SluiceRenderer* renderer, std::uint64_t value) {
    return guarded(nullptr, [&]() -> Status {
        return renderer == nullptr ? isNull("renderer") : renderer->timeline().signal(value);
    });
}

SluiceResult timelineWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
    SluiceResult answer = SLUICE_OK;
    const SluiceResult failure = guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        answer = renderer->timeline().wait(value, timeout_ns);
        return {};
    });
    return failure != SLUICE_OK ? failure : answer;
}

Status checkDirection(std::uint32_t direction) {
    if (direction > SLUICE_RENDERER_TO_HOST) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "direction", fmt::format("{} is not a SluiceDirection", direction),
                     ""};
    }
    return {};
}

SluiceResult timelineValue(SluiceRenderer* renderer, std::uint32_t direction, std::uint64_t* value) {
    return guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr || value == nullptr) {
            return isNull("renderer or value");
        }
        if (Status status = checkDirection(direction); !status) {
            return status;
        }
        Result<std::uint64_t> now = renderer->timeline().value(static_cast<SluiceDirection>(direction));
        if (!now) {
            return now.error();
        }
        *value = now.value();
        return {};
    });
}

SluiceResult timelineExport(SluiceRenderer* renderer, std::uint32_t direction, std::uint64_t value, std::int32_t* fd,
                            SluiceError* error) {
    if (fd != nullptr) {
        *fd = -1;
    }
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr || fd == nullptr) {
            return isNull("renderer or fd");
        }
        if (Status status = checkDirection(direction); !status) {
            return status;
        }
        Result<UniqueFd> exported = renderer->timeline().exportFd(static_cast<SluiceDirection>(direction), value);
        if (!exported) {
            return exported.error();
        }
        *fd = exported.value().release();
        return {};
    });
}

SluiceResult probeFormat(const SluiceHostServices* host, const SluiceCreateInfo* create_info, std::uint32_t format,
                         std::uint32_t width, std::uint32_t height, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (Status status = checkSize(width, height); !status) {
            return status;
        }
        if (findFormat(format) == nullptr) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "format", fmt::format("{} is not a SluiceFormat", format), ""};
        }
        if (Status status = checkServices(host); !status) {
            return status;
        }
        if (Status status = checkCreateHeader(create_info); !status) {
            return status;
        }
        const SluiceHostServices services = readAbiStruct(*host);
        if (services.canary == nullptr) {
            return isNull("host.canary");
        }
        Result<std::unique_ptr<Device>> device = deviceFor(services, *create_info);
        if (!device) {
            return device.error();
        }
        return proveFormat(*device.value(), services, static_cast<SluiceFormat>(format), width, height, format);
    });
}

void destroy(SluiceRenderer* renderer) {
    // Nobody to tell: the failure itself has gone to the log.
    (void)guarded(nullptr, [&]() -> Status {
        SluiceRenderer::destroy(std::unique_ptr<SluiceRenderer>(renderer));
        return {};
    });
}

constexpr SluiceRendererApi kApi = {sizeof(SluiceRendererApi),
                                    SLUICE_ABI_VERSION,
                                    "sluice-renderer-vk",
                                    SLUICE_RENDERER_VERSION,
                                    describe,
                                    explainNeeds,
                                    create,
                                    info,
                                    resize,
                                    setParticles,
                                    setEnvironment,
                                    submitFrame,
                                    poll,
                                    timelineSignal,
                                    timelineWait,
                                    timelineValue,
                                    timelineExport,
                                    probeFormat,
                                    destroy,
                                    setSimulation,
                                    simulate,
                                    simulationWait,
                                    simulationStats,
                                    simulationBodies,
                                    setBody,
                                    setFlow,
                                    resetSimulation};

}  // namespace

const SluiceRendererApi* rendererApi(std::uint32_t abi_version) {
    return (abi_version >> 16U) == SLUICE_ABI_MAJOR ? &kApi : nullptr;
}

}  // namespace sluice::vk
