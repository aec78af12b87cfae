// SPDX-License-Identifier: MIT
// One GL context of the program: its tracker, its fluid, and what the report says of it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "payload/gl_calls.hpp"
#include "payload/own_context.hpp"
#include "payload/settings.hpp"
#include "payload/uniform_blocks.hpp"
#include "payload/water.hpp"
#include "tracker/frame_tracker.hpp"

namespace sluice::inject {

/// What is common to all contexts.
struct Payload {
    const SluiceInjectShim* shim = nullptr;
    Settings settings;
    GlCalls gl;
    std::string folder;                              ///< of the payload, where libsluice.so lies too
    std::atomic<std::uint64_t> programs_changed{0};  ///< linked or deleted, in whichever context
};

/// Time of the program's thread, in all frames.
struct Spent {
    std::uint64_t frames = 0;
    double seconds = 0, most = 0;
    void add(double s);
};

class Session {
  public:
    Session(Payload& payload, const CurrentContext& current);

    FrameTracker& tracker() { return tracker_; }
    [[nodiscard]] bool fixedFunction() const { return facts_.compatibility; }

    /// The program's swap, before it happens.
    void swap(const CurrentContext& current, const char* route);
    /// Before a draw: gives the tracker what it wants, and the fluid its moment.
    void beforeDraw(std::uint32_t vertices);
    void beforeClear(std::uint32_t mask);
    /// Likewise of one that need not be bound.
    void beforeClearOf(std::uint32_t framebuffer, std::uint32_t mask);
    void beforeBind(std::uint32_t framebuffer);
    void uniform(std::uint32_t program, std::int32_t location, const Matrix& matrix);
    /// What is in the uniform blocks may be another, of another program or in another buffer.
    void blocksChanged() { blocks_changed_ = true; }
    void matrixPushed();
    /// Asks which matrix it is that the next calls change.
    void matrixModeUnknown();
    void listCalled();
    void viewportUnknown() { viewport_share_.reset(); }
    /// The context has been, or is about to be, destroyed: no frame comes any more.
    void retire() { ended_ = true; }
    /// Lets go of the fluid. retire() comes before it.
    void end();
    /// Never again in this context: what went wrong goes to stderr once.
    void giveUp(const std::string& why);

    // For the report.
    [[nodiscard]] const ContextFacts& facts() const { return facts_; }
    [[nodiscard]] const CurrentContext& identity() const { return identity_; }
    [[nodiscard]] const std::map<std::string, std::uint64_t>& routes() const { return routes_; }
    [[nodiscard]] const FrameTracker& tracker() const { return tracker_; }
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    [[nodiscard]] DrawableSize size() const { return size_; }
    [[nodiscard]] std::uint32_t resizes() const { return resizes_; }
    [[nodiscard]] std::uint64_t earlyFrames() const { return early_; }
    [[nodiscard]] const std::vector<std::string>& leaks() const { return leaks_; }
    [[nodiscard]] std::uint64_t audits() const { return audits_; }
    [[nodiscard]] const std::string& failure() const { return failure_; }
    [[nodiscard]] const Spent& spent() const { return spent_; }
    [[nodiscard]] std::uint64_t depthsCleared() const { return depths_cleared_; }
    [[nodiscard]] std::uint64_t errorsOfProgram() const { return errors_; }
    [[nodiscard]] bool ended() const { return ended_; }
    [[nodiscard]] WaterReport water();
    /// Of the last swap.
    [[nodiscard]] std::thread::id thread() const { return thread_; }
    /// Whose it is (sessions.hpp); none: nobody's.
    [[nodiscard]] std::thread::id owner() const { return owner_.load(std::memory_order_relaxed); }
    void own(std::thread::id thread) { owner_.store(thread, std::memory_order_relaxed); }

  private:
    [[nodiscard]] bool passive() const;  ///< no fluid will come: nothing of GL's is touched
    void composeNow();
    void composeAtSwap();
    void composeAudited(const FoundCamera& camera);
    [[nodiscard]] Status compose(const FoundCamera& camera);
    [[nodiscard]] Status composeIn(const FoundCamera& camera);
    [[nodiscard]] Status beginWater();
    void endWater();
    void readBlocks();
    void askDepth();
    void askDepthTest();
    void clearUnusedDepth();
    double viewportShare();
    [[nodiscard]] bool clipsZeroToOne() const;
    void forgetOldPrograms();
    void scanPrograms();
    UniformName nameOf(std::uint32_t program, std::int32_t location);
    void keepErrors();
    [[nodiscard]] bool readsPlainly() const;
    [[nodiscard]] double seenDistance(const FoundCamera& camera) const;
    [[nodiscard]] double time() const;

    Payload& payload_;
    CurrentContext identity_;
    ContextFacts facts_;
    FrameTracker tracker_;
    std::unique_ptr<OwnContext> own_;  ///< outlives the water; only beside a program of OpenGL ES
    std::unique_ptr<Water> water_;
    bool placed_in_own_ = false;  ///< in a scene in a framebuffer of the program's own
    std::uint32_t moved_ = 0;     ///< frames in a row with such a scene, and the fluid placed in the window's
    WaterReport last_water_;
    DrawableSize size_;
    std::map<std::pair<std::uint32_t, std::int32_t>, UniformName> names_;
    std::map<std::uint32_t, std::vector<BlockMatrix>> blocks_;  ///< by program
    std::optional<double> viewport_share_;                      ///< of the window
    bool uses_depth_ = false;                                   ///< the program has cleared it, or tested against it
    bool has_blocks_ = false, blocks_changed_ = true, depth_asked_ = false;
    std::uint32_t block_reads_ = 0, depth_asks_ = 0;  ///< in this frame
    std::map<std::string, std::uint64_t> routes_;
    std::vector<std::string> leaks_;
    std::string failure_;
    Spent spent_;
    std::uint64_t frames_ = 0, early_ = 0, audits_ = 0, errors_ = 0, failed_in_a_row_ = 0, depths_cleared_ = 0;
    std::uint32_t resizes_ = 0;
    bool composed_ = false, ended_ = false;
    std::thread::id thread_ = std::this_thread::get_id();
    std::atomic<std::thread::id> owner_{};
    std::uint64_t programs_seen_ = 0;  ///< of Payload::programs_changed, in names_
    double in_frame_ = 0;              ///< seconds of ours in this frame
};

/// Errors of the program's own that keepErrors() took from the driver, of this thread; 0 when there is none left.
[[nodiscard]] std::uint32_t takeKeptError();

}  // namespace sluice::inject
