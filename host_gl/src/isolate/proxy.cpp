// SPDX-License-Identifier: MIT
#include "isolate/proxy.hpp"

#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "isolate/proxy_parts.hpp"
#include "isolate/proxy_simulation.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/isolate/sealed_memory.hpp"

namespace sluice::host::proxy {

namespace {

/// A process that was asked to die and is alive.
void tellFaultThatNeverCame(const Proxy& self) {
    const isolate::Hello& hello = self.process->hello();
    if (hello.fault_signal == 0 || hello.fault_frame <= self.frame || self.services.log == nullptr) {
        return;
    }
    self.services.log(self.services.user, SLUICE_LOG_WARNING,
                      fmt::format("fault {}-renderer: frame {} never came, the last one was {}: nothing was injected",
                                  hello.fault_signal == SIGSTOP ? "stop"
                                  : hello.fault_in_submit != 0  ? "crash"
                                                                : "kill",
                                  hello.fault_frame, self.frame)
                          .c_str());
}

/// A body that returns a Status where the call has no SluiceError.
template <typename Body>
SluiceResult quietly(Body body) {
    return guarded(nullptr, std::move(body));
}

std::span<const std::byte> bytesOf(const float* values, std::size_t count) {
    return std::as_bytes(std::span(values, values != nullptr ? count : 0));
}

SluiceResult info(SluiceRenderer* renderer, SluiceRendererInfo* out) {
    return quietly([&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(out, "info"); !status) {
            return status;
        }
        Result<Reply> reply = of(renderer)->process->call(isolate::Info{}, {}, "info", {});
        return reply ? filledBy(reply.value().returned, out, "info") : Status{reply.error()};
    });
}

SluiceResult resize(SluiceRenderer* renderer, std::uint32_t width, std::uint32_t height, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        return simply(*of(renderer)->process, isolate::Resize{{}, width, height},
                      fmt::format("resize to {}x{}", width, height), {&of(renderer)->services, nullptr, nullptr});
    });
}

SluiceResult setParticles(SluiceRenderer* renderer, const SluiceParticles* particles, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(particles, "particles"); !status) {
            return status;
        }
        const SluiceParticles given = readAbiStruct(*particles);
        // The renderer would say so, too, but only once they had been copied.
        if (const std::uint32_t most = of(renderer)->max_particles; most != 0 && given.count > most) {
            return Error{SLUICE_ERROR_UNSUPPORTED, "particles",
                         fmt::format("this device takes at most {}, found {}", most, given.count), "use fewer"};
        }
        isolate::SetParticles call;
        call.count = given.count;
        call.radius = given.radius;
        UniqueFd memory;
        if (given.count != 0 && given.position != nullptr) {
            call.has_velocity = given.velocity != nullptr ? 1 : 0;
            call.has_colour = given.colour != nullptr ? 1 : 0;
            call.has_fluid = given.fluid != nullptr ? 1 : 0;
            const std::size_t floats = std::size_t{3} * given.count;
            Result<UniqueFd> copy = isolate::sealedCopy(
                {bytesOf(given.position, floats), bytesOf(given.velocity, floats), bytesOf(given.colour, floats),
                 std::as_bytes(std::span(given.fluid, given.fluid != nullptr ? given.count : 0))});
            if (!copy) {
                return copy.error();
            }
            memory = std::move(copy).value();
        }
        const int fd = memory.get();
        return simply(*of(renderer)->process, call, fmt::format("set_particles of {} particles", given.count), {},
                      std::span(&fd, memory.valid() ? 1 : 0));
    });
}

SluiceResult setEnvironment(SluiceRenderer* renderer, const SluiceEnvironment* environment, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        RendererProcess& process = *of(renderer)->process;
        if (environment == nullptr) {
            return simply(process, isolate::SetEnvironment{}, "set_environment", {});
        }
        if (Status status = checkAbiStruct(environment, "environment"); !status) {
            return status;
        }
        // Before the pixels are read: only these bounds say how many there are.
        const SluiceEnvironment given = readAbiStruct(*environment);
        if (given.pixels == nullptr) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "environment.pixels", "it is NULL",
                         "pass a NULL environment for the procedural sky"};
        }
        if (given.width < 1 || given.width > SLUICE_MAX_EXTENT || given.height < 1 ||
            given.height > SLUICE_MAX_EXTENT) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "size",
                         fmt::format("{}x{} is outside 1..{}", given.width, given.height, SLUICE_MAX_EXTENT), ""};
        }
        const Result<UniqueFd> copy =
            isolate::sealedCopy({bytesOf(given.pixels, std::size_t{3} * given.width * given.height)});
        if (!copy) {
            return copy.error();
        }
        const int fd = copy.value().get();
        return simply(process, isolate::SetEnvironment{{}, given.width, given.height}, "set_environment", {},
                      std::span(&fd, 1));
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
        isolate::SubmitFrame call;
        call.frame = readAbiStruct(*frame);
        of(renderer)->frame = call.frame.frame;
        return simply(*of(renderer)->process, call, fmt::format("submit_frame of frame {}", call.frame.frame), {});
    });
}

SluiceResult poll(SluiceRenderer* renderer, std::uint64_t frame, SluiceFrameStats* stats) {
    SluiceResult answer = SLUICE_OK;
    const SluiceResult failure = quietly([&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(stats, "stats"); !status) {
            return status;
        }
        RendererProcess& process = *of(renderer)->process;
        Result<Reply> reply = process.call(isolate::Poll{{}, frame}, {}, fmt::format("poll of frame {}", frame), {});
        if (!reply) {
            return reply.error();
        }
        answer = static_cast<SluiceResult>(reply.value().returned.result);
        return answer == SLUICE_OK ? filledBy(reply.value().returned, stats, "stats") : Status{};
    });
    return failure != SLUICE_OK ? failure : answer;
}

SluiceResult timelineSignal(SluiceRenderer* renderer, std::uint64_t value) {
    return quietly([&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        Proxy& self = *of(renderer);
        if (!self.by_cpu) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "timeline_signal",
                         "this timeline is signalled by the GL command stream", ""};
        }
        if (self.process->timeline().peerDead()) {
            return Error{SLUICE_ERROR_DEVICE_LOST, "timeline_signal", "the renderer process is gone", ""};
        }
        return self.process->timeline().publish(SLUICE_HOST_TO_RENDERER, value);
    });
}

SluiceResult timelineWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
    SluiceResult answer = SLUICE_OK;
    const SluiceResult failure = quietly([&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        RendererProcess& process = *of(renderer)->process;
        switch (process.timeline().wait(SLUICE_RENDERER_TO_HOST, value, timeout_ns)) {
            case isolate::WaitEnd::Reached:
                break;
            case isolate::WaitEnd::Timeout:
                answer = SLUICE_TIMEOUT;
                break;
            case isolate::WaitEnd::Failed:
                answer = process.timeline().failure();
                break;
            case isolate::WaitEnd::Broken:
                process.condemn("moved its counter back, or far ahead, and was killed");
                [[fallthrough]];
            case isolate::WaitEnd::PeerDead:
                static_cast<void>(process.gone());  // the log is to say why before anybody acts on it
                answer = SLUICE_ERROR_DEVICE_LOST;
                break;
        }
        return {};
    });
    return failure != SLUICE_OK ? failure : answer;
}

SluiceResult timelineValue(SluiceRenderer* renderer, std::uint32_t direction, std::uint64_t* value) {
    return quietly([&]() -> Status {
        if (renderer == nullptr || value == nullptr || direction > SLUICE_RENDERER_TO_HOST) {
            return isNull("renderer or value, or the direction is none");
        }
        Proxy& self = *of(renderer);
        if (direction == SLUICE_RENDERER_TO_HOST || self.by_cpu) {
            *value = self.process->timeline().value(static_cast<SluiceDirection>(direction));
            return {};
        }
        Result<Reply> reply = self.process->call(isolate::TimelineValue{{}, direction}, {}, "timeline_value", {});
        if (!reply) {
            return reply.error();
        }
        *value = reply.value().returned.value;
        return statusOf(reply.value().returned);
    });
}

SluiceResult timelineExport(SluiceRenderer* renderer, std::uint32_t direction, std::uint64_t value, std::int32_t* fd,
                            SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr || fd == nullptr) {
            return isNull("renderer or fd");
        }
        *fd = -1;
        Result<Reply> reply = of(renderer)->process->call(isolate::TimelineExport{{}, direction, value}, {},
                                                          fmt::format("timeline_export of value {}", value), {});
        if (!reply) {
            return reply.error();
        }
        if (Status status = statusOf(reply.value().returned); !status) {
            return status;
        }
        if (reply.value().fds.empty()) {
            return Error{SLUICE_ERROR_INTERNAL, "timeline_export", "no descriptor came with its success",
                         "the plugin is broken"};
        }
        *fd = reply.value().fds.front().release();
        return {};
    });
}

void destroy(SluiceRenderer* renderer) {
    static_cast<void>(quietly([&]() -> Status {
        const std::unique_ptr<Proxy> self(of(renderer));
        if (self && self->process->timeline().peerDead()) {
            static_cast<void>(self->process->gone());  // it was not asked to end, and the log is to say so
        } else if (self) {
            tellFaultThatNeverCame(*self);
            static_cast<void>(
                simply(*self->process, isolate::Destroy{}, "destroy", {&self->services, nullptr, nullptr}));
        }
        return {};
    }));
}

}  // namespace

SluiceRendererApi rendererFunctions() {
    SluiceRendererApi table{};
    table.info = info;
    table.resize = resize;
    table.set_particles = setParticles;
    table.set_environment = setEnvironment;
    table.submit_frame = submitFrame;
    table.poll = poll;
    table.timeline_signal = timelineSignal;
    table.timeline_wait = timelineWait;
    table.timeline_value = timelineValue;
    table.timeline_export = timelineExport;
    table.destroy = destroy;
    addSimulation(table);
    return table;
}

}  // namespace sluice::host::proxy
