// SPDX-License-Identifier: MIT
// A host without OpenGL: it imports what the renderer shares into a Vulkan device of its own.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "device/device.hpp"
#include "plugin/api.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/fd.hpp"
#include "sluice/plugin.h"

namespace sluice::vk::test {

/// Sets the core's test switches for the devices created while it lives.
struct Switched {
    explicit Switched(const TestSwitches& switches) { setTestSwitches(switches); }
    Switched(const Switched&) = delete;
    Switched& operator=(const Switched&) = delete;
    ~Switched() { setTestSwitches({}); }
};

/// A traced event with its name copied.
struct SeenEvent {
    SluiceTraceEvent event{};
    std::string name;
};

/// Services that behave as a correct host does, and can be told to fail. Outlives the renderers that use it.
class FakeHost {
  public:
    explicit FakeHost(bool tracing = false);
    FakeHost(const FakeHost&) = delete;
    FakeHost& operator=(const FakeHost&) = delete;

    [[nodiscard]] const SluiceHostServices* services() const { return &services_; }
    [[nodiscard]] SluiceHostServices& mutableServices() { return services_; }
    /// For the first device of this machine, bridged, two sets of 64x48, validation off.
    [[nodiscard]] SluiceCreateInfo createInfo() const;

    /// (role, set) of the images that the host holds now.
    [[nodiscard]] const std::map<std::pair<std::uint32_t, std::uint32_t>, SluiceImageExport>& held() const {
        return held_;
    }
    [[nodiscard]] std::vector<SeenEvent> events() const;
    [[nodiscard]] std::vector<std::string> log() const;

    /// What a shared image holds now, rows bottom-up. The frame that wrote it has finished, and no later one has it.
    /// Empty if it cannot be read.
    [[nodiscard]] std::vector<std::byte> texels(SluiceImageRole role, std::uint32_t set) const;

    /// Writes a shared image, rows bottom-up, as the host's own drawing would; it is the host's.
    [[nodiscard]] bool fill(SluiceImageRole role, std::uint32_t set, std::span<const std::byte> texels) const;

    bool keep_descriptors = false;             ///< before create: texels() will be asked for, or fill()
    int fail_share_after = -1;                 ///< the n-th share_image fails; -1: none
    std::uint32_t fail_canary_formats = 0;     ///< bit per format: the host says that it saw wrong texels
    std::uint32_t corrupt_canary_formats = 0;  ///< bit per format: the host writes back a wrong pattern
    int shares = 0;
    int canaries = 0;

  private:
    static void onLog(void* user, std::int32_t level, const char* message);
    static void onTrace(void* user, const SluiceTraceEvent* event);
    static SluiceResult onShare(void* user, const SluiceImageExport* image, SluiceError* error);
    static void onRetire(void* user, std::uint32_t role, std::uint32_t set);
    static SluiceResult onCanary(void* user, const SluiceImageExport* image, std::uint32_t seed, SluiceError* error);

    SluiceHostServices services_{};
    std::unique_ptr<Device> device_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, SluiceImageExport> held_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, UniqueFd> descriptors_;
    mutable std::mutex lock_;
    std::vector<SeenEvent> events_;
    std::vector<std::string> log_;
};

/// The renderer of a FakeHost; destroyed at the end.
class TestRenderer {
  public:
    TestRenderer(const FakeHost& host, const SluiceCreateInfo& info);
    TestRenderer(const TestRenderer&) = delete;
    TestRenderer& operator=(const TestRenderer&) = delete;
    ~TestRenderer() { destroy(); }
    void destroy();

    [[nodiscard]] SluiceRenderer* get() const { return renderer_; }
    [[nodiscard]] SluiceResult result() const { return result_; }
    [[nodiscard]] const SluiceError& error() const { return error_; }
    /// The submission of a frame; its message is in error().
    SluiceResult submit(const SluiceFrame& frame);

  private:
    SluiceRenderer* renderer_ = nullptr;
    SluiceResult result_ = SLUICE_OK;
    SluiceError error_{};
};

[[nodiscard]] inline const SluiceRendererApi& api() {
    return *rendererApi(SLUICE_ABI_VERSION);
}

/// Frame k as a host would send it: a camera at the origin, water, 1 set per `image_sets`.
[[nodiscard]] SluiceFrame frameOf(std::uint64_t k, std::uint32_t image_sets, SluiceView view = SLUICE_VIEW_ECHO);

/// `count` particles in a ball of 0.5 m, 2 m in front of the camera of frameOf.
struct ParticleCloud {
    explicit ParticleCloud(std::uint32_t count);
    std::vector<float> position;
    SluiceParticles particles{};
};

/// Open descriptors of this process.
[[nodiscard]] std::size_t openDescriptors();

}  // namespace sluice::vk::test
