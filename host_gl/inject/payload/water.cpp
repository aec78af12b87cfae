// SPDX-License-Identifier: MIT
#include "payload/water.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <utility>

#include "payload/placement.hpp"
#include "sluice/sluice.h"

namespace sluice::inject {

namespace {

/// Metres: what hides a part of the box is as deep as the box, but not as deep as the world: a weapon before the eye
/// must not hold up water that is far behind it.
float depthOfBox(const WaterPlan& plan) {
    return std::hypot(plan.high[0] - plan.low[0], plan.high[1] - plan.low[1], plan.high[2] - plan.low[2]);
}

/// libsluice.so's functions. Never closed: threads of the renderer's may outlive the last context.
struct Api {
    decltype(&sluice_api_version) version;
    decltype(&sluice_options_defaults) optionsDefaults;
    decltype(&sluice_create) create;
    decltype(&sluice_begin_frame) beginFrame;
    decltype(&sluice_set_camera) setCamera;
    decltype(&sluice_end_frame) endFrame;
    decltype(&sluice_destroy) destroy;
    decltype(&sluice_water_defaults) waterDefaults;
    decltype(&sluice_set_water) setWater;
    decltype(&sluice_set_look) setLook;
    decltype(&sluice_set_sky) setSky;
    decltype(&sluice_last_error) lastError;
    decltype(&sluice_statistics) statistics;
};

template <typename T>
bool look(void* library, const char* name, T& out) {
    out = reinterpret_cast<T>(::dlsym(library, name));
    return out != nullptr;
}

Result<Api> loadApi(const std::string& folder) {
    const std::string beside = folder + "libsluice.so.1";
    const std::string path = ::access(beside.c_str(), R_OK) == 0 ? beside : folder + "../libsluice.so.1";
    void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        const char* why = ::dlerror();
        return Error{SLUICE_ERROR_UNSUPPORTED, "libsluice.so", why == nullptr ? path : why,
                     "install Sluice as a whole, or run sluice inject --off"};
    }
    Api api{};
    const bool whole =
        look(library, "sluice_api_version", api.version) &&
        look(library, "sluice_options_defaults", api.optionsDefaults) && look(library, "sluice_create", api.create) &&
        look(library, "sluice_begin_frame", api.beginFrame) && look(library, "sluice_set_camera", api.setCamera) &&
        look(library, "sluice_end_frame", api.endFrame) && look(library, "sluice_destroy", api.destroy) &&
        look(library, "sluice_water_defaults", api.waterDefaults) && look(library, "sluice_set_water", api.setWater) &&
        look(library, "sluice_set_look", api.setLook) && look(library, "sluice_set_sky", api.setSky) &&
        look(library, "sluice_last_error", api.lastError) && look(library, "sluice_statistics", api.statistics);
    if (!whole || (api.version() >> 16U) != SLUICE_API_MAJOR) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, "libsluice.so", path + " is of another version",
                     "install Sluice as a whole"};
    }
    return api;
}

/// What was written last, by whichever thread. Never destroyed: one of them may write at the very end.
struct Said {
    std::mutex mutex;
    std::string line;
};
Said& said() {
    static Said* const only = new Said;
    return *only;
}

/// Warnings and errors, which the user can do something about.
void logLine(void* /*user*/, std::int32_t level, const char* message) {
    if (level >= SLUICE_LOG_WARNING) {
        const std::lock_guard lock(said().mutex);
        said().line = message;
        (void)std::fprintf(stderr, "sluice inject: %s\n", message);
    }
}

/// A third of the box, to its left, and not to its top: it breaks like a dam.
WaterBlock columnOf(const WaterPlan& plan) {
    WaterBlock block{plan.low, plan.high, {}};
    block.high[0] = plan.low[0] + (plan.high[0] - plan.low[0]) / 3.0F;
    block.high[1] = plan.low[1] + (plan.high[1] - plan.low[1]) * 0.8F;
    return block;
}

constexpr std::uint32_t kFramesBetweenLooks = 16;  // each asks the renderer's process
constexpr std::uint32_t kMostRestarts = 4;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class LibraryWater final : public Water {
  public:
    LibraryWater(const Api& api, const Placement& placement) : api_(api), placement_(placement) {}
    LibraryWater(const LibraryWater&) = delete;
    LibraryWater& operator=(const LibraryWater&) = delete;
    ~LibraryWater() override { api_.destroy(fluid_); }

    Status create(const Settings& settings, const FoundCamera& camera) {
        SluiceOptions options{};
        api_.optionsDefaults(&options, sizeof(options));
        options.process = settings.same_process ? SLUICE_PROCESS_SAME : SLUICE_PROCESS_OWN;
        options.plugin = settings.plugin.empty() ? nullptr : settings.plugin.c_str();
        options.log = logLine;
        options.timings = settings.audit ? 1 : 0;
        options.start_deadline = double{settings.start_deadline};
        // Frames of a fixed length are to come out the same whenever the renderer is there.
        options.start_in_background = settings.step > 0 || settings.same_process ? 0 : 1;
        started_ = options.start_in_background == 0;
        if (const SluiceResult result = api_.create(&options, &fluid_); result != SLUICE_OK) {
            return failure(result, nullptr);
        }
        const PlacedCamera placed = placement_.camera(camera);
        view_ = placed.view;
        projection_ = placed.projection;
        if (settings.look) {
            (void)api_.setLook(fluid_, &*settings.look);
        }
        if (settings.sky) {
            (void)api_.setSky(fluid_, &*settings.sky);
        }
        plan_ = settings.water;
        report_.placements = 1;
        return setWater(plan_);
    }

    Status begin(double time) override {
        startAgainIfItStands();
        const double start = now();
        const SluiceResult result = api_.beginFrame(fluid_, view_.data(), projection_.data(), time);
        begun_ = true;
        report_.begin_s += now() - start;
        if (result < SLUICE_OK) {
            last_error_ = api_.lastError(fluid_);
            if (!started_) {
                return failure(result, fluid_);  // each try would hold up a frame
            }
        }
        started_ = started_ || result == SLUICE_OK;
        return {};  // sluice_end_frame will say so again, where it counts
    }

    Status compose(const FoundCamera& camera, double time) override {
        const PlacedCamera placed = placement_.camera(camera);
        view_ = placed.view;
        projection_ = placed.projection;
        if (!begun_) {
            (void)begin(time);
        }
        begun_ = false;
        const double start = now();
        SluiceResult result = api_.setCamera(fluid_, view_.data(), projection_.data());
        result = result == SLUICE_OK ? api_.endFrame(fluid_) : result;
        report_.whole_s += now() - start;
        return result == SLUICE_OK ? Status{} : failure(result, fluid_);
    }

    Status placeAnew(const FoundCamera& camera, double distance) override {
        placement_ = Placement(plan_, camera, distance);
        if (!plan_.in_view) {
            return {};
        }
        ++report_.placements;
        begun_ = false;  // a frame that has begun has other water
        return setWater(plan_);
    }

    WaterReport report() override {
        SluiceStatistics statistics{};
        statistics.struct_size = sizeof(statistics);
        if (fluid_ != nullptr && api_.statistics(fluid_, &statistics) == SLUICE_OK) {
            report_.frames = statistics.frames;
            report_.frames_without = statistics.frames_without;
            if (statistics.renderers != 0) {  // none can be asked once the context is no longer current
                report_.steps = statistics.steps;
                report_.particles = statistics.particles;
                report_.renderers = statistics.renderers;
                report_.device = &statistics.device[0];
            }
            report_.capture_s = statistics.capture_seconds;
            report_.hand_off_s = statistics.hand_over_seconds;
            report_.fluid_s = statistics.fluid_seconds;
            report_.simulation_s = statistics.simulation_seconds;
            report_.composite_s = statistics.composite_seconds;
        }
        report_.last_error = last_error_;
        report_.units_per_metre = placement_.unitsPerMetre();
        report_.up = placement_.up();
        report_.restarts = std::min(restarts_, kMostRestarts);
        return report_;
    }

  private:
    Status failure(SluiceResult result, const Sluice* of) {
        last_error_ = api_.lastError(of);
        return Error{static_cast<SluiceResultCode>(result), "", last_error_, ""};
    }

    /// After a step that failed for good (what is solid may leap through the fluid in a program that nobody knows) all
    /// that there is stands still for as long as the program runs.
    /// Between two frames: a frame that has begun has no other water.
    void startAgainIfItStands() {
        SluiceStatistics statistics{};
        statistics.struct_size = sizeof(statistics);
        if (++frames_ % kFramesBetweenLooks != 0 || restarts_ > kMostRestarts ||
            api_.statistics(fluid_, &statistics) != SLUICE_OK || statistics.simulation_failed == 0) {
            return;
        }
        ++restarts_;
        if (restarts_ > kMostRestarts) {
            (void)std::fprintf(stderr, "sluice inject: the fluid stands still from here on: it has failed %u times\n",
                               restarts_);
            return;
        }
        (void)std::fputs("sluice inject: the fluid begins again\n", stderr);
        (void)setWater(plan_);  // the next frame says what is wrong with it
    }

    Status setWater(const WaterPlan& plan) {
        SluiceWater water{};
        api_.waterDefaults(&water, sizeof(water));
        std::vector<SluiceBlock> blocks;
        std::vector<WaterBlock> wanted = plan.blocks;
        if (wanted.empty() && plan.emitters.empty()) {
            wanted.push_back(columnOf(plan));
        }
        for (const WaterBlock& block : wanted) {
            SluiceBlock& out = blocks.emplace_back();
            std::copy(block.low.begin(), block.low.end(), &out.low[0]);
            std::copy(block.high.begin(), block.high.end(), &out.high[0]);
            std::copy(block.velocity.begin(), block.velocity.end(), &out.velocity[0]);
        }
        water.radius = plan.radius;
        std::copy(plan.low.begin(), plan.low.end(), &water.low[0]);
        std::copy(plan.high.begin(), plan.high.end(), &water.high[0]);
        std::copy(plan.gravity.begin(), plan.gravity.end(), &water.gravity[0]);
        water.iterations = plan.iterations;
        water.viscosity = plan.viscosity;
        water.vorticity = plan.vorticity;
        water.blocks = blocks.data();
        water.block_count = static_cast<std::uint32_t>(blocks.size());
        water.emitters = plan.emitters.data();
        water.emitter_count = static_cast<std::uint32_t>(plan.emitters.size());
        water.max_particles = plan.max_particles;
        water.depth_scale = plan.depth_scale;
        // So deep unless told otherwise: water that falls behind the edge of a basin is lost to the eye and to the
        // basin.
        water.depth_thickness = plan.depth_thickness > 0 ? plan.depth_thickness : depthOfBox(plan);
        const SluiceResult result = api_.setWater(fluid_, &water);
        return result == SLUICE_OK ? Status{} : failure(result, fluid_);
    }

    Api api_;
    Placement placement_;
    Sluice* fluid_ = nullptr;
    Matrix view_ = kIdentity, projection_ = kIdentity;
    WaterReport report_;
    std::string last_error_;
    WaterPlan plan_;
    std::uint32_t frames_ = 0, restarts_ = 0;
    bool begun_ = false;
    bool started_ = false;  ///< there has been a renderer
};

}  // namespace

bool wasSaid(const std::string& message) {
    const std::lock_guard lock(said().mutex);
    return message == said().line;
}

Result<std::unique_ptr<Water>> createWater(const std::string& folder, const Settings& settings,
                                           const FoundCamera& camera, double distance) {
    const Result<Api> api = loadApi(folder);
    if (!api) {
        return api.error();
    }
    auto water = std::make_unique<LibraryWater>(api.value(), Placement(settings.water, camera, distance));
    if (Status status = water->create(settings, camera); !status) {
        return status.error();
    }
    return std::unique_ptr<Water>(std::move(water));
}

}  // namespace sluice::inject
