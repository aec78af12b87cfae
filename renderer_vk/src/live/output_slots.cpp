// SPDX-License-Identifier: MIT
#include "live/output_slots.hpp"

#include <fmt/format.h>
#include <shaders/publish_comp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "live/one_set.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kBindings = 8;

/// Mirrors shaders/publish.comp.
struct Push {
    std::uint32_t count, changing, several;
};

Result<Buffer> makeFloats(const Device& device, std::uint32_t particles, std::size_t each, const char* name) {
    const VkDeviceSize bytes = VkDeviceSize{particles} * each * sizeof(float);
    if (bytes > device.properties.limits.maxStorageBufferRange) {
        return Error{SLUICE_ERROR_UNSUPPORTED, name,
                     fmt::format("{} particles need a buffer of {} bytes, this device binds at most {}", particles,
                                 bytes, device.properties.limits.maxStorageBufferRange),
                     "simulate fewer particles"};
    }
    return Buffer::create(device, {bytes,
                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                       VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   BufferPlace::Device, name, true});
}

}  // namespace

Result<std::unique_ptr<OutputSlots>> OutputSlots::create(const Device& device, std::uint32_t slots,
                                                         std::uint32_t particles, float radius,
                                                         const std::optional<Anisotropy>& anisotropy,
                                                         const std::optional<FoamSettings>& foam, bool several_fluids) {
    if (Status status = anisotropy ? checkAnisotropy(*anisotropy) : Status{}; !status) {
        return status.error();
    }
    if (Status status = foam ? checkWhitewater(foam->ranges) : Status{}; !status) {
        return status.error();
    }
    auto made = std::make_unique<OutputSlots>(device);
    made->particles_ = particles;
    made->radius_ = radius;
    made->anisotropy_ = anisotropy;
    made->foam_ = foam;
    for (std::uint32_t i = 0; i < slots; ++i) {
        Result<Buffer> position = makeFloats(device, particles, 3, "simulated positions");
        if (!position) {
            return position.error();
        }
        Result<Buffer> velocity = makeFloats(device, particles, 3, "simulated velocities");
        if (!velocity) {
            return velocity.error();
        }
        Result<Buffer> draw = Buffer::create(
            device, {sizeof(VkDrawIndirectCommand), VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                     BufferPlace::Device, "simulated particles' number", true});
        if (!draw) {
            return draw.error();
        }
        Buffer ellipsoids;
        if (anisotropy) {
            Result<Buffer> shapes = makeFloats(device, particles, kEllipsoidFloats, "simulated ellipsoids");
            if (!shapes) {
                return shapes.error();
            }
            ellipsoids = std::move(shapes).value();
        }
        Buffer whitewater;
        if (foam) {
            Result<Buffer> white = makeFloats(device, particles, kWhitewaterFloats, "simulated whitewater");
            if (!white) {
                return white.error();
            }
            whitewater = std::move(white).value();
        }
        Buffer fluids;
        if (several_fluids) {
            Result<Buffer> numbers = makeFloats(device, particles, 1, "simulated particles' fluids");
            if (!numbers) {
                return numbers.error();
            }
            fluids = std::move(numbers).value();
        }
        made->slots_.push_back({std::move(position).value(), std::move(velocity).value(), std::move(draw).value(),
                                std::move(ellipsoids), std::move(whitewater), std::move(fluids)});
    }
    // A frame that is told not to wait (a fault of tests) shall read what is defined.
    const Status cleared = runOnce(device, [&](VkCommandBuffer commands) {
        for (const OutputSlot& slot : made->slots_) {
            device.fn.vkCmdFillBuffer(commands, slot.position.buffer(), 0, VK_WHOLE_SIZE, 0);
            device.fn.vkCmdFillBuffer(commands, slot.velocity.buffer(), 0, VK_WHOLE_SIZE, 0);
            device.fn.vkCmdFillBuffer(commands, slot.draw.buffer(), 0, VK_WHOLE_SIZE, 0);
            for (const Buffer* more : {&slot.ellipsoids, &slot.whitewater}) {
                if (*more) {
                    device.fn.vkCmdFillBuffer(commands, more->buffer(), 0, VK_WHOLE_SIZE, 0);
                }
            }
            if (slot.fluids) {
                device.fn.vkCmdFillBuffer(commands, slot.fluids.buffer(), 0, VK_WHOLE_SIZE, 0);
            }
        }
    });
    if (!cleared) {
        return cleared.error();
    }
    std::array<VkDescriptorType, kBindings> types{};
    types.fill(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    Result<Pipeline> pipeline = createCompute(device, {"publish", publish_comp, types, sizeof(Push), {}});
    if (!pipeline) {
        return pipeline.error();
    }
    made->pipeline_ = std::move(pipeline).value();
    Result<std::unique_ptr<ParticlePlaces>> places = ParticlePlaces::create(device);
    if (!places) {
        return places.error();
    }
    made->places_ = std::move(places).value();
    if (foam) {
        Result<std::unique_ptr<FoamAge>> age = FoamAge::create(device);
        if (!age) {
            return age.error();
        }
        made->foam_age_ = std::move(age).value();
    }
    if (Status status = makeOneSet(device, made->pipeline_, kBindings, made->pool_, made->set_); !status) {
        return status.error();
    }
    return made;
}

OutputSlots::~OutputSlots() {
    device_.fn.vkDestroyDescriptorPool(device_.handle, pool_, nullptr);
}

Status OutputSlots::look(Solver& solver, std::uint64_t value) {
    if (!anisotropy_ && !foam_) {
        return {};
    }
    const DeviceParticles state = solver.onDevice();
    PlaceBuffers places;
    if (state.changing) {
        if (Status status = places_->prepare(state); !status) {
            return status;
        }
        const auto count = [&](VkCommandBuffer commands) { places_->record(commands, state); };
        if (Status status = runOnce(device_, count); !status) {
            return status;
        }
        places = {places_->marks(), places_->before()};
    }
    if (anisotropy_) {
        if (Status status = solver.ellipsoids(*anisotropy_, slot(value).ellipsoids.buffer(), places); !status) {
            return status;
        }
    }
    return foam_ ? whiten(solver, value, places) : Status{};
}

void OutputSlots::forgetFoam() {
    foam_time_ = 0.0;
    if (foam_age_) {
        foam_age_->forget();
    }
}

Status OutputSlots::whiten(Solver& solver, std::uint64_t value, const PlaceBuffers& places) {
    const VkBuffer to = slot(value).whitewater.buffer();
    if (Status status = solver.whitewater(foam_->ranges, to, places); !status) {
        return status;
    }
    const double passed = solver.time() - foam_time_;
    foam_time_ = solver.time();
    return foam_age_->age(solver.onDevice(), to, places,
                          static_cast<float>(std::exp2(-std::max(passed, 0.0) / foam_->life)));
}

Status OutputSlots::publish(const DeviceParticles& state, std::uint64_t value, const VkSemaphoreSubmitInfo& signal) {
    if (state.living > particles_) {
        return Error{SLUICE_ERROR_INTERNAL, "output slot",
                     fmt::format("has room for {} particles, and {} live", particles_, state.living), ""};
    }
    const OutputSlot& to = slot(value);
    if (Status status = state.changing ? places_->prepare(state) : Status{}; !status) {
        return status;
    }
    // The last use of the set has ended: publish waits for it. What is not read has a stand-in.
    const std::array<VkBuffer, kBindings> buffers{state.position,
                                                  state.velocity,
                                                  state.identity,
                                                  to.position.buffer(),
                                                  to.velocity.buffer(),
                                                  state.changing ? places_->marks() : state.identity,
                                                  state.changing ? places_->before() : state.identity,
                                                  to.fluids ? to.fluids.buffer() : state.identity};
    writeOneSet(device_, set_, buffers);
    const VkDrawIndirectCommand draw{state.living, 1, 0, 0};
    const Push push{state.count, state.changing ? 1U : 0U, to.fluids ? 1U : 0U};
    return runOnce(device_,
                   [&](VkCommandBuffer commands) {
                       device_.fn.vkCmdUpdateBuffer(commands, to.draw.buffer(), 0, sizeof draw, &draw);
                       memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                     VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                     VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
                       if (state.changing) {
                           places_->record(commands, state);
                       }
                       device_.fn.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle);
                       device_.fn.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout, 0,
                                                          1, &set_, 0, nullptr);
                       device_.fn.vkCmdPushConstants(commands, pipeline_.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                                     sizeof push, &push);
                       device_.fn.vkCmdDispatch(commands, (state.count + kGroup - 1) / kGroup, 1, 1);
                   },
                   {&signal, 1});
}

ParticleBuffers OutputSlots::buffers(std::uint64_t value) const {
    ParticleBuffers out{slot(value).position.buffer(), particles_, radius_, slot(value).draw.buffer()};
    if (anisotropy_) {
        out.ellipsoids = slot(value).ellipsoids.buffer();
        out.longest = longestStretch(anisotropy_->ratio);
    }
    out.whitewater = slot(value).whitewater.buffer();
    if (slot(value).fluids) {
        out.fluids = slot(value).fluids.buffer();
    }
    return out;
}

}  // namespace sluice::vk
