// SPDX-License-Identifier: MIT
#include "simulation/transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "device/commands.hpp"
#include "device/one_shot.hpp"

namespace sluice::vk {
namespace {

using Texel = std::array<float, 4>;

std::vector<Texel> padded(std::span<const float> triples, std::size_t count) {
    std::vector<Texel> vectors(count, Texel{});
    for (std::size_t i = 0; i < triples.size() / 3; ++i) {
        vectors[i] = {triples[3 * i], triples[3 * i + 1], triples[3 * i + 2], 0.0F};
    }
    return vectors;
}

template <typename T>
Status upload(const Device& device, const Buffer& to, const std::vector<T>& values) {
    const VkDeviceSize bytes = values.size() * sizeof(T);
    Result<Buffer> staging =
        Buffer::create(device, {bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Upload, "simulation upload"});
    if (!staging) {
        return staging.error();
    }
    std::memcpy(staging.value().mapped().data(), values.data(), bytes);
    return runOnce(device, [&](VkCommandBuffer commands) {
        const VkBufferCopy whole{0, 0, bytes};
        device.fn.vkCmdCopyBuffer(commands, staging.value().buffer(), to.buffer(), 1, &whole);
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    });
}

template <typename T>
Result<std::vector<T>> download(const Device& device, const Buffer& from, std::size_t count) {
    std::vector<T> values(count);
    if (count == 0) {
        return values;
    }
    const VkDeviceSize bytes = count * sizeof(T);
    Result<Buffer> staging =
        Buffer::create(device, {bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback, "simulation download"});
    if (!staging) {
        return staging.error();
    }
    const Status status = runOnce(device, [&](VkCommandBuffer commands) {
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
        const VkBufferCopy whole{0, 0, bytes};
        device.fn.vkCmdCopyBuffer(commands, from.buffer(), staging.value().buffer(), 1, &whole);
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    });
    if (!status) {
        return status.error();
    }
    std::memcpy(values.data(), staging.value().mapped().data(), bytes);
    return values;
}

/// The three numbers of each vector, put where its identity says.
std::vector<float> byIdentity(const std::vector<Texel>& vectors, const std::vector<std::uint32_t>& identity) {
    std::vector<float> triples(3 * vectors.size());
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        std::copy_n(vectors[i].begin(), 3, triples.begin() + 3 * static_cast<std::ptrdiff_t>(identity[i]));
    }
    return triples;
}

Result<std::vector<std::uint32_t>> identities(const Device& device, const SimulationBuffers& buffers,
                                              std::uint32_t count, bool odd) {
    return download<std::uint32_t>(device, buffers[odd ? Slot::IdentityOut : Slot::IdentityIn], count);
}

}  // namespace

Result<Buffer> uploadMeshes(const Device& device, const DistanceGrid& grid) {
    std::vector<float> content(8);
    const auto low = narrow(grid.low);
    std::copy(low.begin(), low.end(), content.begin());
    content[3] = grid.spacing > 0.0 ? static_cast<float>(1.0 / grid.spacing) : 0.0F;
    std::memcpy(&content[4], grid.size.data(), sizeof grid.size);
    content.insert(content.end(), grid.nodes.begin(), grid.nodes.end());
    content.resize(std::max<std::size_t>(content.size(), 9));
    Result<Buffer> made = Buffer::create(
        device, {content.size() * sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                 BufferPlace::Device, "simulation meshes"});
    if (made) {
        if (Status status = upload(device, made.value(), content); !status) {
            return status.error();
        }
    }
    return made;
}

Result<Buffer> uploadDepthField(const Device& device, const DepthField& field) {
    const DepthHeader header = depthHeader(field);
    std::vector<float> content(sizeof header / sizeof(float));
    std::memcpy(content.data(), &header, sizeof header);
    content.insert(content.end(), field.depth.begin(), field.depth.end());
    content.resize(std::max(content.size(), sizeof header / sizeof(float) + 1));
    const VkDeviceSize bytes = content.size() * sizeof(float);
    if (bytes > device.properties.limits.maxStorageBufferRange) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "simulation: depth field",
                     fmt::format("{}x{} texels need a buffer of {} bytes, this device binds at most {}", field.width,
                                 field.height, bytes, device.properties.limits.maxStorageBufferRange),
                     "use a smaller image"};
    }
    Result<Buffer> made =
        Buffer::create(device, {bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                BufferPlace::Device, "simulation depth field"});
    if (made) {
        if (Status status = upload(device, made.value(), content); !status) {
            return status.error();
        }
    }
    return made;
}

Status uploadParticles(const Device& device, const SimulationBuffers& buffers, std::span<const float> positions,
                       std::span<const float> velocities, std::span<const std::uint32_t> fluids) {
    const std::size_t count = positions.size() / 3;
    if (count == 0) {
        return {};
    }
    std::vector<std::uint32_t> identity(count);
    for (std::size_t i = 0; i < count; ++i) {
        identity[i] = static_cast<std::uint32_t>(i);
    }
    Status status = upload(device, buffers[Slot::PositionIn], padded(positions, count));
    if (status) {
        std::vector<Texel> moving = padded(velocities, count);
        for (std::size_t i = 0; i < fluids.size(); ++i) {
            moving[i][3] = static_cast<float>(fluids[i]);
        }
        status = upload(device, buffers[Slot::VelocityIn], moving);
    }
    if (status) {
        status = upload(device, buffers[Slot::IdentityIn], identity);
    }
    return status;
}

Status copyParticles(const Device& device, const SimulationBuffers& from, const SimulationBuffers& to,
                     std::uint32_t count, bool odd) {
    if (count == 0) {
        return {};
    }
    return runOnce(device, [&](VkCommandBuffer commands) {
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
        for (const auto& [slot, bytes] : {std::pair{odd ? Slot::PositionOut : Slot::PositionIn, sizeof(Texel)},
                                          {odd ? Slot::VelocityOut : Slot::VelocityIn, sizeof(Texel)},
                                          {odd ? Slot::IdentityOut : Slot::IdentityIn, sizeof(std::uint32_t)}}) {
            const VkBufferCopy all{0, 0, count * bytes};
            device.fn.vkCmdCopyBuffer(commands, from[slot].buffer(), to[slot].buffer(), 1, &all);
        }
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    });
}

Result<ParticleState> downloadParticles(const Device& device, const SimulationBuffers& buffers, std::uint32_t count,
                                        bool odd) {
    const auto identity = identities(device, buffers, count, odd);
    if (!identity) {
        return identity.error();
    }
    const auto position = download<Texel>(device, buffers[odd ? Slot::PositionOut : Slot::PositionIn], count);
    if (!position) {
        return position.error();
    }
    const auto velocity = download<Texel>(device, buffers[odd ? Slot::VelocityOut : Slot::VelocityIn], count);
    if (!velocity) {
        return velocity.error();
    }
    // Identities have gaps once somebody is gone.
    std::vector<std::uint32_t> living;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (position.value()[i][3] == 0.0F) {
            living.push_back(i);
        }
    }
    std::sort(living.begin(), living.end(),
              [&](std::uint32_t a, std::uint32_t b) { return identity.value()[a] < identity.value()[b]; });
    ParticleState state;
    for (const std::uint32_t i : living) {
        const Texel& x = position.value()[i];
        const Texel& v = velocity.value()[i];
        state.position.insert(state.position.end(), x.begin(), x.begin() + 3);
        state.velocity.insert(state.velocity.end(), v.begin(), v.begin() + 3);
        state.fluid.push_back(static_cast<std::uint32_t>(v[3]));
    }
    return state;
}

Result<std::vector<float>> downloadDensities(const Device& device, const SimulationBuffers& buffers,
                                             std::uint32_t count, bool odd) {
    const auto identity = identities(device, buffers, count, odd);
    if (!identity) {
        return identity.error();
    }
    const auto measured = download<Texel>(device, buffers[Slot::Pushed], count);
    if (!measured) {
        return measured.error();
    }
    std::vector<std::pair<std::uint32_t, float>> ordered(count);
    for (std::size_t i = 0; i < count; ++i) {
        ordered[i] = {identity.value()[i], measured.value()[i][3]};
    }
    std::sort(ordered.begin(), ordered.end());
    std::vector<float> densities(count);
    std::transform(ordered.begin(), ordered.end(), densities.begin(), [](const auto& pair) { return pair.second; });
    return densities;
}

Result<NeighbourLists> downloadLists(const Device& device, const SimulationBuffers& buffers, std::uint32_t count,
                                     bool odd) {
    const auto identity = identities(device, buffers, count, odd);
    if (!identity) {
        return identity.error();
    }
    const auto length = download<std::uint32_t>(device, buffers[Slot::ListCount], count);
    if (!length) {
        return length.error();
    }
    const auto rows =
        download<std::uint32_t>(device, buffers[Slot::List], std::size_t{buffers.stride()} * buffers.neighbours);
    if (!rows) {
        return rows.error();
    }
    // The step's own In buffers are Out by now; predicted positions lie in their order.
    const auto before = identities(device, buffers, count, !odd);
    if (!before) {
        return before.error();
    }
    const auto predicted = download<Texel>(device, buffers[Slot::Predicted], count);
    if (!predicted) {
        return predicted.error();
    }
    NeighbourLists lists;
    lists.position = byIdentity(predicted.value(), before.value());
    lists.list.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::uint32_t>& list = lists.list[identity.value()[i]];
        for (std::uint32_t k = 0; k < length.value()[i]; ++k) {
            list.push_back(identity.value()[rows.value()[std::size_t{k} * buffers.stride() + i]]);
        }
    }
    return lists;
}

}  // namespace sluice::vk
