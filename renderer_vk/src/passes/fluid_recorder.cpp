// SPDX-License-Identifier: MIT
#include "passes/fluid_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "device/one_shot.hpp"
#include "passes/capture_depth.hpp"
#include "passes/context.hpp"
#include "passes/echo.hpp"
#include "passes/filter.hpp"
#include "passes/foam.hpp"
#include "passes/frame_constants.hpp"
#include "passes/shade.hpp"
#include "passes/splat.hpp"
#include "passes/surface.hpp"
#include "passes/tiles.hpp"
#include "sluice/format.hpp"

namespace sluice::vk {

struct FluidRecorder::State {
    explicit State(const Device& owner) : device(owner) {}

    const Device& device;
    std::vector<FrameArena> arenas;
    PassImages images;
    // A pass that no plan has asked for yet is not built.
    // Of spheres and of ellipsoids.
    std::array<std::optional<SplatDepthPass>, 2> splat_depth;
    std::optional<TilesPass> tiles;
    std::optional<FilterPass> filter;
    std::optional<NormalsPass> normals;
    std::array<std::optional<SplatThicknessPass>, 4> splat_thickness;  ///< and those with several looks
    std::array<std::optional<BlurThicknessPass>, 2> blur_thickness;    ///< likewise
    std::optional<SplatFoamPass> splat_foam;
    ShadePass shade;
    std::optional<EchoPass> echo;
    std::optional<ClearPass> clear;
    std::optional<CaptureDepthPass> capture_depth;
    std::optional<Plan> plan;
};

namespace {

/// Moves the value out of a Result or hands its error on.
template <typename T>
Status take(Result<T> result, T& into) {
    if (!result) {
        return result.error();
    }
    into = std::move(result).value();
    return {};
}

/// Builds a pass that the plan has and the recorder lacks.
template <typename Pass, typename... Variant>
Status build(const Device& device, const Plan& plan, PassId id, std::optional<Pass>& pass, Variant... variant) {
    if (pass || findPass(plan, id) == nullptr) {
        return {};
    }
    auto made = Pass::create(device, variant...);
    if (!made) {
        return made.error();
    }
    pass = std::move(made).value();
    return {};
}

Result<Image> makePlaceholder(const Device& device) {
    auto image = Image::create(device, {VK_FORMAT_R16G16B16A16_SFLOAT, 1, 1,
                                        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT, false, "placeholder"});
    if (!image) {
        return image;
    }
    const Status status = runOnce(device, [&](VkCommandBuffer commands) {
        fullBarrier(device, commands, image.value().image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                    VK_IMAGE_LAYOUT_GENERAL);
    });
    if (!status) {
        return status.error();
    }
    return image;
}

Result<Image> makeOwn(const Device& device, const PlannedImage& planned) {
    const FormatInfo* format = findFormat(static_cast<std::uint32_t>(planned.format));
    assert(format != nullptr);
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                              VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (isDrawn(planned.id)) {
        usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    }
    return Image::create(device, {static_cast<VkFormat>(format->vk_format), planned.width, planned.height, usage, false,
                                  toString(planned.id).data()});
}

Result<Buffer> makeNearDraw(const Device& device) {
    return Buffer::create(device, {2 * sizeof(VkDrawIndirectCommand),
                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   BufferPlace::Device, "draw of near spheres"});
}

Result<Buffer> makeTileList(const Device& device, std::uint32_t width, std::uint32_t height) {
    return Buffer::create(device, {tileListBytes(width, height),
                                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   BufferPlace::Device, "tile list"});
}

Result<Image> makeEnvironment(const Device& device, const SluiceEnvironment& environment) {
    const std::uint32_t limit = device.properties.limits.maxImageDimension2D;
    if (environment.width == 0 || environment.height == 0 || environment.width > limit || environment.height > limit ||
        environment.pixels == nullptr) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "environment map",
                     fmt::format("{}x{} pixels cannot be uploaded", environment.width, environment.height),
                     fmt::format("give 1 to {} pixels each way", limit)};
    }
    const std::size_t pixels = std::size_t{environment.width} * environment.height;
    std::vector<float> texels(pixels * 4, 1.0F);
    for (std::size_t index = 0; index < pixels; ++index) {
        std::copy_n(environment.pixels + index * 3, 3, texels.data() + index * 4);
    }
    auto image =
        Image::create(device, {VK_FORMAT_R32G32B32A32_SFLOAT, environment.width, environment.height,
                               VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, false, "environment"});
    if (!image) {
        return image;
    }
    if (Status status = uploadImage(device, image.value(), std::as_bytes(std::span(texels))); !status) {
        return status.error();
    }
    return image;
}

}  // namespace

FluidRecorder::FluidRecorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
FluidRecorder::FluidRecorder(FluidRecorder&& other) noexcept = default;
FluidRecorder& FluidRecorder::operator=(FluidRecorder&& other) noexcept = default;
FluidRecorder::~FluidRecorder() = default;

Result<FluidRecorder> FluidRecorder::create(const Device& device) {
    if (!device.features.storage_write_without_format) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "shaderStorageImageWriteWithoutFormat",
                     "this device cannot write the shared images from one shader", "use another Vulkan device"};
    }
    if ((device.capabilities.blendable_formats & formatBit(SLUICE_FORMAT_R32F)) == 0) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "blending of R32F",
                     "this device cannot blend the fluid's depth and thickness in 32-bit float images",
                     "use another Vulkan device"};
    }
    auto state = std::make_unique<State>(device);
    for (std::uint32_t slot = 0; slot < SLUICE_MAX_IMAGE_SETS; ++slot) {
        auto arena = FrameArena::create(device, sizeof(FrameConstants));
        if (!arena) {
            return arena.error();
        }
        state->arenas.push_back(std::move(arena).value());
    }
    for (const Status& status : {take(makePlaceholder(device), state->images.nothing_to_read),
                                 take(makePlaceholder(device), state->images.nothing_to_write)}) {
        if (!status) {
            return status.error();
        }
    }
    return FluidRecorder(std::move(state));
}

Status FluidRecorder::prepare(const Plan& plan) {
    if (state_->plan && *state_->plan == plan) {
        return {};
    }
    const Device& device = state_->device;
    const std::size_t shape = plan.ellipsoids ? 1 : 0;
    const std::size_t looks = plan.several_looks ? 1 : 0;
    if (plan.several_looks && (device.capabilities.blendable_formats & formatBit(SLUICE_FORMAT_RGBA32F)) == 0) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "blending of RGBA32F",
                     "this device cannot sum what several fluids absorb", "give all fluids one look"};
    }
    for (const Status& status :
         {build(device, plan, PassId::SplatDepth, state_->splat_depth.at(shape), plan.ellipsoids),
          build(device, plan, PassId::Tiles, state_->tiles), build(device, plan, PassId::Filter, state_->filter),
          build(device, plan, PassId::Normals, state_->normals),
          build(device, plan, PassId::SplatThickness, state_->splat_thickness.at(shape + 2 * looks), plan.ellipsoids,
                plan.several_looks),
          build(device, plan, PassId::BlurThickness, state_->blur_thickness.at(looks), plan.several_looks),
          build(device, plan, PassId::SplatFoam, state_->splat_foam), build(device, plan, PassId::Echo, state_->echo),
          build(device, plan, PassId::Clear, state_->clear)}) {
        if (!status) {
            return status;
        }
    }
    if (findPass(plan, PassId::Shade) != nullptr) {
        if (Status status = state_->shade.prepare(device, plan); !status) {
            return status;
        }
    }
    if (findPass(plan, PassId::SplatDepth) != nullptr && !state_->images.near_draw) {
        if (Status status = take(makeNearDraw(device), state_->images.near_draw); !status) {
            return status;
        }
    }
    if (!state_->plan || state_->plan->images != plan.images) {
        std::vector<std::pair<PlanImage, Image>> made;
        for (const PlannedImage& planned : plan.images) {
            auto image = makeOwn(state_->device, planned);
            if (!image) {
                return image.error();
            }
            made.emplace_back(planned.id, std::move(image).value());
        }
        // Both lists have room for every tile of the full resolution, the larger of the two.
        std::array<Buffer, 2> lists;
        for (Buffer& list : lists) {
            if (findPass(plan, PassId::Tiles) == nullptr) {
                break;
            }
            if (Status status = take(makeTileList(device, plan.width, plan.height), list); !status) {
                return status;
            }
        }
        (void)state_->device.waitIdle();
        state_->images.surface_tiles = std::move(lists[0]);
        state_->images.thickness_tiles = std::move(lists[1]);
        for (std::size_t index = 0; index < state_->images.own.size(); ++index) {
            if (static_cast<PlanImage>(index) != PlanImage::Environment) {
                state_->images.own[index] = Image();
            }
        }
        for (auto& [id, image] : made) {
            state_->images.own[static_cast<std::size_t>(id)] = std::move(image);
        }
    }
    state_->plan = plan;
    return {};
}

Status FluidRecorder::setEnvironment(const SluiceEnvironment* environment) {
    Image map;
    if (environment != nullptr) {
        auto made = makeEnvironment(state_->device, *environment);
        if (!made) {
            return made.error();
        }
        map = std::move(made).value();
    }
    (void)state_->device.waitIdle();
    state_->images.own[static_cast<std::size_t>(PlanImage::Environment)] = std::move(map);
    return {};
}

const Image* FluidRecorder::image(PlanImage id) const {
    const Image& image = state_->images[id];
    return image ? &image : nullptr;
}

Status FluidRecorder::record(VkCommandBuffer commands, const SluiceFrame& frame, const Plan& plan,
                             const FrameTargets& targets, const ParticleBuffers& particles, PassTimer& timer,
                             const DepthCapture& capture) {
    assert(state_->plan && *state_->plan == plan);
    FrameArena& arena = state_->arenas.at(frame.image_set);
    FrameConstants constants = makeFrameConstants(frame, plan, targets, particles);
    // A pixel less than the limit, for the rounding of positions and sizes.
    constants.thickness[3] =
        state_->device.features.large_points
            ? nearestPointDepth(constants, state_->device.properties.limits.pointSizeRange[1] - 1.0F,
                                plan.ellipsoids ? particles.longest : 1.0F)
            : 1e30F;
    arena.begin(std::as_bytes(std::span(&constants, 1)));
    const PassContext context{state_->device, commands, frame, plan, targets, particles, timer, arena, state_->images};
    const std::size_t shape = plan.ellipsoids ? 1 : 0;
    const std::size_t looks = plan.several_looks ? 1 : 0;
    openImages(context);
    if (capture.into != VK_NULL_HANDLE) {
        if (!state_->capture_depth) {
            auto made = CaptureDepthPass::create(state_->device);
            if (!made) {
                return made.error();
            }
            state_->capture_depth = std::move(made).value();
        }
        state_->capture_depth->record(context, capture);
    }
    for (const PlannedPass& pass : plan.passes) {
        switch (pass.id) {
            case PassId::SplatDepth:
                state_->splat_depth.at(shape)->record(context);
                break;
            case PassId::Tiles:
                state_->tiles->record(context);
                break;
            case PassId::Filter:
                state_->filter->record(context);
                break;
            case PassId::Normals:
                state_->normals->record(context);
                break;
            case PassId::SplatThickness:
                state_->splat_thickness.at(shape + 2 * looks)->record(context);
                break;
            case PassId::BlurThickness:
                state_->blur_thickness.at(looks)->record(context);
                break;
            case PassId::SplatFoam:
                state_->splat_foam->record(context);
                break;
            case PassId::Shade:
                state_->shade.record(context);
                break;
            case PassId::Echo:
                state_->echo->record(context);
                break;
            case PassId::Clear:
                state_->clear->record(context);
                break;
            case PassId::Count:
                break;
        }
        if (arena.failure() != VK_SUCCESS) {
            return vulkanError(arena.failure(), fmt::format("vkAllocateDescriptorSets of frame {}", frame.frame));
        }
    }
    return {};
}

}  // namespace sluice::vk
