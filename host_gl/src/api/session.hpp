// SPDX-License-Identifier: MIT
// What a Sluice of sluice/sluice.h is: the engine's wishes, and a FluidHost in the context that is current.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/background_start.hpp"
#include "api/camera.hpp"
#include "api/current_context.hpp"
#include "api/log_sink.hpp"
#include "api/target.hpp"
#include "api/timings.hpp"
#include "api/told.hpp"
#include "frame/kept_scene.hpp"
#include "sluice/host_gl/fluid_host.hpp"
#include "sluice/ledger/live.hpp"
#include "sluice/sluice.h"

namespace sluice::host {

/// Every call is one of sluice/sluice.h, on the thread of the context. What it promises of GL state holds of each.
class Session {
  public:
    /// `options` has passed its checks. A context must be current.
    [[nodiscard]] static Result<std::unique_ptr<Session>> create(const SluiceOptions& options);
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    /// Asks nothing of GL unless the context of the objects is current.
    ~Session();

    [[nodiscard]] Status resize(std::uint32_t width, std::uint32_t height);
    [[nodiscard]] Status beginFrame(const float* view, const float* projection, double time);
    [[nodiscard]] Status setCamera(const float* view, const float* projection);
    [[nodiscard]] Status endFrame();

    [[nodiscard]] Status setWater(const SluiceWater* water);
    [[nodiscard]] Status setFlow(const SluiceFlow* flow);
    [[nodiscard]] Status setBody(std::uint32_t body, const SluiceBodyTarget* target);
    [[nodiscard]] Status bodies(SluiceBodies* bodies);
    [[nodiscard]] Status setEnvironment(const SluiceEnvironment* environment);
    void setLook(const SluiceFluid& look) { look_ = look; }
    [[nodiscard]] Status setOtherLooks(std::span<const SluiceLook> looks);
    void setSky(const SluiceSky& sky) { sky_ = sky; }
    void setEnabled(bool enabled) { enabled_ = enabled; }
    [[nodiscard]] Result<SluiceStatistics> statistics();

    /// Its code: a failure is kept as the last error, and told to the log unless that has heard of it.
    SluiceResult told(const Status& status, Once once);
    [[nodiscard]] const char* lastError() const { return last_error_.c_str(); }

  private:
    Session(const SluiceOptions& options, LogSink log)
        : log_(std::move(log)),
          extent_{options.width, options.height},
          follows_drawable_(options.width == 0 || options.height == 0),
          timeline_(static_cast<SluiceTimelineKind>(options.timeline)),
          ledger_log_(ledgerLog(options.ledger_log)),
          trace_(options.timings != 0 ? std::make_unique<Trace>(kTraceCapacity) : nullptr) {}

    /// There is fluid to be drawn.
    [[nodiscard]] bool active() const { return enabled_ && has_water_; }
    /// The present context is the one that the FluidHost lives in, and its objects are there.
    [[nodiscard]] bool reachable() const;
    /// Begins to, or does, start the plugin in a process of its own.
    [[nodiscard]] Status isolate(const SluiceOptions& options, std::filesystem::path plugin,
                                 const std::filesystem::path& folder);
    /// The plugin is there. SLUICE_NOT_READY while it is being started.
    [[nodiscard]] Status awaited();
    [[nodiscard]] Status notThere() const;
    /// A FluidHost in the present context, of the right size, with the scene that was asked for.
    [[nodiscard]] Status settle(const std::optional<Extent>& wanted);
    [[nodiscard]] Status start(const CurrentContext& context, const Extent& extent);
    [[nodiscard]] Status giveScene();
    /// Keeps how a start ended, or what was tried to end it.
    [[nodiscard]] Status started(Status status);
    /// What a frame begins with: everything is there, and the fluid is asked to go on.
    [[nodiscard]] Status flowOn();
    /// Lets go of the FluidHost, with or without GL.
    void drop();
    [[nodiscard]] Status draw();
    /// The camera of the frame, as the depth buffer has it.
    [[nodiscard]] Result<SluiceCamera> depthCamera();
    /// The size to draw at: what was told, if the target is not another size, or what it has.
    [[nodiscard]] Result<Extent> extentOf(const Target& target, const CurrentContext& present) const;
    [[nodiscard]] static std::string ledgerLog(const char* asked);
    [[nodiscard]] Status startLedger();

    static constexpr std::size_t kTraceCapacity = 4096;  // events of a frame, and of the simulation beside it

    std::optional<PluginLibrary> library_;
    std::unique_ptr<BackgroundStart> starting_;
    std::optional<Error> not_started_;  ///< why there will be no plugin
    LogSink log_;
    Extent extent_{};
    bool follows_drawable_;
    SluiceTimelineKind timeline_;

    KeptScene scene_;                 ///< environment and simulation, for another context
    std::optional<SluiceFlow> flow_;  ///< of that simulation, if it was changed
    bool has_water_ = false;
    bool meets_depth_ = false;     ///< the fluid collides with what the engine's depth shows
    std::uint32_t particles_ = 0;  ///< at the start
    SluiceFluid look_{};
    std::vector<SluiceLook> other_looks_;
    SluiceSky sky_{};
    bool enabled_ = true;

    CurrentContext context_;
    Resolve resolve_;
    std::uint32_t witness_ = 0;                   ///< a GL object by which the context is known again
    std::string ledger_log_;                      ///< still to be begun; empty: none, or it has been
    std::unique_ptr<ledger::LiveLedger> ledger_;  ///< outlives the host
    std::unique_ptr<Trace> trace_;                ///< likewise; only with SluiceOptions::timings
    std::unique_ptr<FluidHost> host_;
    std::uint32_t contexts_ = 0;
    CurrentContext tried_in_;  ///< the last start
    /// Why there is none in the present context, or none with the scene that was asked for.
    std::optional<Error> start_error_;
    CurrentContext begun_in_;              ///< the frame
    std::optional<Error> begin_error_;     ///< why it could not begin
    bool began_active_ = false;            ///< there was fluid to be drawn then
    std::uint32_t tries_ = 0, to_go_ = 0;  ///< that failed since the last success; frames until the next

    std::optional<Matrix> view_, projection_;
    std::optional<double> clock_;  ///< of the last frame
    double owed_ = 0.0;            ///< seconds that the fluid is behind
    std::uint64_t value_ = 0;      ///< of the simulation, asked for
    bool pending_ = false;         ///< that value has not been drawn
    bool in_frame_ = false;
    std::array<float, 2> range_at_begin_{0.0F, 1.0F};  ///< glDepthRange
    bool range_told_ = false;
    std::uint64_t drawn_ = 0;  ///< the host's number of the last frame with fluid; 0: none in this context
    std::uint64_t frames_ = 0, frames_without_ = 0;
    double end_frame_seconds_ = 0.0, wait_seconds_ = 0.0;
    Timings timings_;
    std::string last_error_;
    Told told_;
};

}  // namespace sluice::host
