// SPDX-License-Identifier: MIT
#include "pass_rig.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <span>
#include <utility>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "device/structs.hpp"
#include "memory/buffer.hpp"
#include "passes/capture_depth.hpp"

namespace sluice::vk::test {
namespace {

/// Timestamps around every pass.
class RigTimer final : public PassTimer {
  public:
    explicit RigTimer(const Device& device) : device_(device) {
        auto info = vkStruct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = 2 * SLUICE_MAX_PASSES;
        device.fn.vkCreateQueryPool(device.handle, &info, nullptr, &pool_);
        device.fn.vkResetQueryPool(device.handle, pool_, 0, info.queryCount);
    }
    RigTimer(const RigTimer&) = delete;
    RigTimer& operator=(const RigTimer&) = delete;
    ~RigTimer() override { device_.fn.vkDestroyQueryPool(device_.handle, pool_, nullptr); }

    void begin(VkCommandBuffer commands, const PassLabel& label) override {
        names_.emplace_back(label.name);
        device_.fn.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, next_++);
    }
    void end(VkCommandBuffer commands) override {
        device_.fn.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, next_++);
    }
    std::vector<std::pair<std::string, double>> read() const {
        std::vector<std::pair<std::string, double>> result;
        for (std::uint32_t index = 0; index < names_.size(); ++index) {
            std::array<std::uint64_t, 2> ticks{};
            device_.fn.vkGetQueryPoolResults(device_.handle, pool_, 2 * index, 2, sizeof ticks, ticks.data(), 8,
                                             VK_QUERY_RESULT_64_BIT);
            result.emplace_back(names_[index], static_cast<double>(ticks[1] - ticks[0]) *
                                                   double{device_.properties.limits.timestampPeriod} * 1e-6);
        }
        return result;
    }

  private:
    const Device& device_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::uint32_t next_ = 0;
    std::vector<std::string> names_;
};

/// Collects the first failure and turns the rest into nothing.
struct Rig {
    const Device& device;
    std::string failure;

    Image image(VkFormat format, std::uint32_t width, std::uint32_t height, VkImageUsageFlags usage) {
        auto made = Image::create(device, {format, width, height, usage, false, "rig"});
        if (!made) {
            failure = made.error().message();
            return {};
        }
        return std::move(made).value();
    }
    void upload(const Image& image, std::span<const std::byte> texels) {
        if (const Status status = uploadImage(device, image, texels); !status) {
            failure = status.error().message();
        }
    }
    template <typename T>
    std::vector<T> download(const Image& image) {
        auto bytes = downloadImage(device, image, sizeof(T));
        if (!bytes) {
            failure = bytes.error().message();
            return {};
        }
        std::vector<T> texels(bytes.value().size() / sizeof(T));
        std::memcpy(texels.data(), bytes.value().data(), texels.size() * sizeof(T));
        return texels;
    }
    std::vector<std::array<float, 4>> downloadHalves(const Image& image) {
        std::vector<std::array<float, 4>> result;
        for (const auto& texel : download<std::array<std::uint16_t, 4>>(image)) {
            result.push_back({glm::unpackHalf1x16(texel[0]), glm::unpackHalf1x16(texel[1]),
                              glm::unpackHalf1x16(texel[2]), glm::unpackHalf1x16(texel[3])});
        }
        return result;
    }
};

constexpr VkImageUsageFlags kInput = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr VkImageUsageFlags kOutput =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

void setTriple(float (&into)[3], float x, float y, float z) {
    into[0] = x;
    into[1] = y;
    into[2] = z;
}

}  // namespace

PassRig::PassRig() {
    DeviceRequest request;
    request.match_host = false;
    request.validation = true;
    auto device = Device::create(request);
    if (!device) {
        failure_ = device.error().message();
        return;
    }
    device_ = std::move(device).value();
    auto recorder = FluidRecorder::create(*device_);
    if (!recorder) {
        failure_ = recorder.error().message();
        return;
    }
    recorder_ = std::make_unique<FluidRecorder>(std::move(recorder).value());
}

PassRig::~PassRig() = default;

RigResult PassRig::render(const RigScene& scene) {
    RigResult result;
    if (!recorder_) {
        result.failure = failure_;
        return result;
    }
    const Device& device = *device_;
    Rig rig{device, {}};
    const std::uint32_t width = scene.width;
    const std::uint32_t height = scene.height;
    const std::size_t pixels = std::size_t{width} * height;

    SluiceSceneNeeds needs{};
    needs.struct_size = sizeof needs;
    needs.width = width;
    needs.height = height;
    needs.particle_count = static_cast<std::uint32_t>(scene.positions.size() / 3);
    needs.has_environment_map = scene.environment.empty() ? 0 : 1;
    needs.outputs = scene.outputs;
    needs.fluid = scene.fluid;
    needs.other_look_count = static_cast<std::uint32_t>(scene.absorption.size());
    const std::vector<float>& splats = scene.ellipsoids.empty() ? scene.positions : scene.ellipsoids;
    if (!scene.ellipsoids.empty()) {
        needs.particle_count = static_cast<std::uint32_t>(scene.ellipsoids.size() / 9);
        needs.fluid.ellipsoids = 1;
    }
    auto plan = makePlan(needs);
    if (!plan) {
        result.failure = plan.error().message();
        return result;
    }
    result.plan = plan.value();
    if (const Status status = recorder_->prepare(result.plan); !status) {
        result.failure = status.error().message();
        return result;
    }
    SluiceEnvironment environment{sizeof environment, scene.environment_width, scene.environment_height,
                                  scene.environment.data()};
    if (const Status status = recorder_->setEnvironment(scene.environment.empty() ? nullptr : &environment); !status) {
        result.failure = status.error().message();
        return result;
    }

    const bool native = scene.encoding == SLUICE_DEPTH_WINDOW;
    const Image host_colour = rig.image(VK_FORMAT_R8G8B8A8_UNORM, width, height, kInput);
    const Image host_depth = rig.image(native ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_R32_SFLOAT, width, height, kInput);
    const Image fluid_colour = rig.image(VK_FORMAT_R16G16B16A16_SFLOAT, width, height, kOutput);
    const Image fluid_depth = rig.image(VK_FORMAT_R32_SFLOAT, width, height, kOutput);
    const Image fluid_normal = rig.image(VK_FORMAT_R16G16B16A16_SFLOAT, width, height, kOutput);
    const Image fluid_thickness = rig.image(VK_FORMAT_R32_SFLOAT, width, height, kOutput);
    std::vector<std::uint8_t> colour = scene.host_colour;
    colour.resize(pixels * 4, 128);
    std::vector<float> depth = scene.host_depth;
    depth.resize(pixels, native ? 1.0F : INFINITY);
    rig.upload(host_colour, std::as_bytes(std::span(colour)));
    rig.upload(host_depth, std::as_bytes(std::span(depth)));

    auto particles = Buffer::create(device, {std::max<std::size_t>(splats.size(), 3) * sizeof(float),
                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::Upload, "rig particles"});
    if (!particles) {
        result.failure = particles.error().message();
        return result;
    }
    std::ranges::copy(std::as_bytes(std::span(splats)), particles.value().mapped().begin());
    std::vector<float> white(std::max<std::size_t>(4 * scene.foam.size(), 4));
    for (std::size_t i = 0; i < scene.foam.size(); ++i) {
        white[4 * i + 3] = scene.foam[i];
    }
    auto whitewater = Buffer::create(device, {white.size() * sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                              BufferPlace::Upload, "rig whitewater"});
    if (!whitewater) {
        result.failure = whitewater.error().message();
        return result;
    }
    std::ranges::copy(std::as_bytes(std::span(white)), whitewater.value().mapped().begin());

    auto fluids = Buffer::create(device, {std::max<std::size_t>(scene.fluids.size(), 1) * sizeof(std::uint32_t),
                                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::Upload, "rig fluids"});
    if (!fluids) {
        result.failure = fluids.error().message();
        return result;
    }
    std::ranges::copy(std::as_bytes(std::span(scene.fluids)), fluids.value().mapped().begin());

    SluiceFrame frame{};
    frame.struct_size = sizeof frame;
    frame.frame = 1;
    frame.outputs = scene.outputs;
    frame.camera = scene.camera;
    frame.sky = scene.sky;
    frame.fluid = scene.fluid;
    frame.other_look_count = needs.other_look_count;
    for (std::size_t i = 0; i < scene.absorption.size(); ++i) {
        std::ranges::copy(scene.absorption[i], std::begin(frame.other_looks[i].absorption));
    }
    const bool want_normal = (scene.outputs & SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL)) != 0;
    const bool want_thickness = (scene.outputs & SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS)) != 0;
    FrameTargets targets{host_colour.ref(),
                         host_depth.ref(),
                         fluid_colour.ref(),
                         fluid_depth.ref(),
                         want_normal ? fluid_normal.ref() : ImageRef{},
                         want_thickness ? fluid_thickness.ref() : ImageRef{},
                         scene.encoding};
    DepthCapture capture;
    Buffer captured;
    if (scene.capture_scale != 0) {
        auto made = Buffer::create(device, {captureBytes(scene.width, scene.height, scene.capture_scale),
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::Readback, "rig captured"});
        if (!made) {
            result.failure = made.error().message();
            return result;
        }
        captured = std::move(made).value();
        capture = {captured.buffer(), scene.capture_scale, 0.25F};
    }
    RigTimer timer(device);
    if (!rig.failure.empty()) {
        result.failure = rig.failure;
        return result;
    }
    Status recorded;
    Status status = runOnce(device, [&](VkCommandBuffer commands) {
        for (const Image* image : {&fluid_colour, &fluid_depth, &fluid_normal, &fluid_thickness}) {
            fullBarrier(device, commands, image->image(), VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                        VK_IMAGE_LAYOUT_GENERAL);
        }
        recorded = recorder_->record(
            commands, frame, result.plan, targets,
            {particles.value().buffer(), needs.particle_count, scene.radius, VK_NULL_HANDLE, particles.value().buffer(),
             scene.longest, whitewater.value().buffer(), fluids.value().buffer()},
            timer, capture);
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    });
    status = recorded ? status : recorded;
    if (!status) {
        result.failure = status.error().message();
        return result;
    }
    result.milliseconds = timer.read();
    if (captured) {
        result.captured.resize(captured.size() / sizeof(float));
        std::memcpy(result.captured.data(), captured.mapped().data(), captured.size());
    }
    result.colour = rig.downloadHalves(fluid_colour);
    result.depth = rig.download<float>(fluid_depth);
    if (want_normal) {
        result.normal_out = rig.downloadHalves(fluid_normal);
    }
    if (want_thickness) {
        result.thickness_out = rig.download<float>(fluid_thickness);
    }
    if (const Image* surface = recorder_->image(result.plan.surface)) {
        result.surface = rig.download<float>(*surface);
    }
    if (const Image* image = recorder_->image(PlanImage::DepthA)) {
        result.depth_a = rig.download<float>(*image);
    }
    if (const Image* image = recorder_->image(PlanImage::Normal)) {
        result.normal = rig.downloadHalves(*image);
    }
    if (const Image* image = recorder_->image(PlanImage::Thickness)) {
        result.thickness = rig.download<float>(*image);
        result.thickness_width = image->width();
        result.thickness_height = image->height();
    }
    if (const Image* image = recorder_->image(PlanImage::Foam)) {
        result.foam = rig.download<float>(*image);
    }
    if (const Image* image = recorder_->image(PlanImage::OpticalDepth)) {
        result.optical = rig.download<std::array<float, 4>>(*image);
    }
    result.failure = rig.failure;
    return result;
}

SluiceCamera perspective(double fov_y, double aspect, float near, float far, std::array<double, 2> shift) {
    SluiceCamera camera{};
    const double f = 1.0 / std::tan(fov_y / 2);
    const double n = double{near};
    const double p = double{far};
    camera.projection[0] = static_cast<float>(f / aspect);
    camera.projection[5] = static_cast<float>(f);
    camera.projection[8] = static_cast<float>(shift[0]);
    camera.projection[9] = static_cast<float>(shift[1]);
    camera.projection[10] = static_cast<float>(-(p + n) / (p - n));
    camera.projection[11] = -1.0F;
    camera.projection[14] = static_cast<float>(-2 * p * n / (p - n));
    camera.view[0] = camera.view[5] = camera.view[10] = camera.view[15] = 1.0F;
    camera.near_plane = near;
    camera.far_plane = far;
    return camera;
}

void lookAt(SluiceCamera& camera, std::array<double, 3> eye, std::array<double, 3> at) {
    using V = std::array<double, 3>;
    const auto dot = [](V a, V b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const auto cross = [](V a, V b) {
        return V{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto unit = [&](V a) {
        const double length = std::sqrt(dot(a, a));
        return V{a[0] / length, a[1] / length, a[2] / length};
    };
    const V forward = unit({at[0] - eye[0], at[1] - eye[1], at[2] - eye[2]});
    const V right = unit(cross(forward, {0, 1, 0}));
    const V up = cross(right, forward);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        camera.view[axis * 4] = static_cast<float>(right[axis]);
        camera.view[axis * 4 + 1] = static_cast<float>(up[axis]);
        camera.view[axis * 4 + 2] = static_cast<float>(-forward[axis]);
    }
    camera.view[12] = static_cast<float>(-dot(right, eye));
    camera.view[13] = static_cast<float>(-dot(up, eye));
    camera.view[14] = static_cast<float>(dot(forward, eye));
}

SluiceSky clearDay() {
    SluiceSky sky{};
    setTriple(sky.zenith, 0.16F, 0.32F, 0.65F);
    setTriple(sky.horizon, 0.62F, 0.72F, 0.82F);
    setTriple(sky.ground, 0.20F, 0.18F, 0.15F);
    setTriple(sky.to_sun, 0.39F, 0.78F, -0.49F);
    setTriple(sky.sun_radiance, 40.0F, 38.0F, 33.0F);
    return sky;
}

}  // namespace sluice::vk::test
