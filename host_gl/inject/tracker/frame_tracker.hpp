// SPDX-License-Identifier: MIT
// From the calls of a frame to its camera, and to the moment at which the scene is done and the overlay begins. Pure:
// no OpenGL; whoever feeds it asks OpenGL for matrices when the tracker wants them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tracker/projection.hpp"

namespace sluice::inject {

enum class CameraRoute { Automatic, FixedFunction, Uniforms };
/// When the fluid is drawn: at the last change from perspective to flat of the frame before, or to a cleared depth; at
/// the first one; or at the swap.
enum class OverlaySwitch { Automatic, First, Never };
enum class ViewRule { Automatic, FirstDraw, Pushed, Identity };

/// What a program's profile may lay down.
struct TrackerRules {
    CameraRoute route = CameraRoute::Automatic;
    OverlaySwitch overlay = OverlaySwitch::Automatic;
    ViewRule view = ViewRule::Automatic;
    std::optional<double> near_plane, far_plane;
};

/// What the name of a uniform says about its matrix.
enum class UniformName { Unknown, View, ModelView };

/// A camera, and how much there is to say for it.
struct FoundCamera {
    Lens lens;
    Matrix view = kIdentity;
    double scale = 1;          ///< units of the lens per unit of the program's world
    bool zero_to_one = false;  ///< what OpenGL clips depth to where the fluid is drawn
    double confidence = 0;     ///< of the lens, 0 to 1
    double view_confidence = 0;
    std::string source, view_source;
    std::uint64_t vertices = 0;
};

/// One projection of a frame, for the report.
struct SeenLens {
    Lens lens;
    std::string source;
    std::uint64_t vertices = 0;
    std::uint32_t draws = 0, matrices = 0;
};

struct FrameSummary {
    std::vector<SeenLens> lenses;
    std::uint32_t flat_draws = 0, foreign_draws = 0;  ///< without perspective; into framebuffers other than the scene's
    std::uint32_t target = 0;                         ///< the scene's framebuffer
    std::uint32_t switches = 0;                       ///< from perspective to an overlay
    bool composited_early = false;
    std::map<std::string, std::uint64_t> rejected;  ///< why matrices were no camera, since the beginning
};

/// One context's frames, one after the other.
class FrameTracker {
  public:
    explicit FrameTracker(TrackerRules rules = {}) : rules_(rules) {}

    /// glMatrixMode: whether it is the projection, or the model-view, that the next calls change.
    void matrixMode(bool projection, bool model_view);
    void matrixChanged();
    /// glPushMatrix: if true, give the model-view matrix to pushedView(); else pushedView(kIdentity) will do.
    [[nodiscard]] bool wantsPushedView() const;
    void pushedView(const Matrix& model_view);
    void popped();
    /// Levels of the model-view stack above the lowest.
    [[nodiscard]] std::size_t stackDepth() const { return below_ + stack_.size(); }
    /// OpenGL's own word for it. What lies there is not known if it is another depth.
    void stackIs(std::size_t depth);
    /// Before a draw: if true, give both matrices of the fixed function to fixedMatrices() first.
    [[nodiscard]] bool wantsMatrices() const;
    void fixedMatrices(const Matrix& projection, const Matrix& model_view);

    void useProgram(std::uint32_t program);
    /// `slot` tells a program's matrices apart: one that was the camera and is flat now is an overlay's.
    void uniform(std::uint32_t program, std::int64_t slot, const Matrix& matrix, UniformName name);
    /// All its uniforms are zero.
    void programLinked(std::uint32_t program) { programs_.erase(program); }
    /// Its name may be another's; it lives on as long as it is in use.
    void programDeleted(std::uint32_t program);
    [[nodiscard]] std::uint32_t program() const { return program_; }
    void depth(const DepthRules& rules);

    /// Before the binding changes. True: the framebuffer that is bound now holds the complete scene, and the fluid
    /// belongs into it.
    [[nodiscard]] bool bindFramebuffer(std::uint32_t framebuffer);
    [[nodiscard]] std::uint32_t framebuffer() const { return framebuffer_; }
    /// Where the scene is drawn: 0, the default framebuffer, or one of the program's own if it draws no scene there.
    [[nodiscard]] std::uint32_t target() const { return target_; }
    /// The fluid cannot be drawn into that one: a shadow map, or a format that nobody knows.
    void refuse(std::uint32_t framebuffer);
    /// After it: one that was bound is not any more.
    void framebufferDeleted(std::uint32_t framebuffer);
    /// Gives, at a draw into the default framebuffer, the share of it that the viewport has.
    void viewportBy(std::function<double()> share) { viewport_share_ = std::move(share); }
    /// No framebuffer of the program's own can be reached.
    void stayInTheWindow() { only_window_ = true; }
    void compileList(bool compiling);
    [[nodiscard]] bool compiling() const { return compiling_; }
    [[nodiscard]] bool listsChangeMode() const { return lists_change_mode_; }

    /// True: the scene is complete, so that the fluid belongs before this draw.
    [[nodiscard]] bool draw(std::uint32_t vertices);
    /// The depth of the scene is about to be cleared: true likewise.
    [[nodiscard]] bool clearsDepth();

    /// The camera of what has been drawn in this frame so far, or of the last frame that had one.
    [[nodiscard]] std::optional<FoundCamera> camera() const;
    /// That camera is of this frame.
    [[nodiscard]] bool sceneSeen() const { return !groups_.empty(); }
    /// The last draw where the scene is drawn was one of it.
    [[nodiscard]] bool inScene() const { return scene_open_; }
    void endFrame();
    [[nodiscard]] const FrameSummary& lastFrame() const { return last_; }

  private:
    /// What stood lowest on the stack while so much was drawn.
    struct Candidate {
        Matrix matrix;
        std::uint64_t vertices = 0;
    };
    struct Group {
        bool fixed = false;
        bool small = false;  ///< in a corner of the picture
        std::vector<Candidate> views;
        Reading reading;
        FoundCamera camera;
        std::uint64_t vertices = 0;
        std::uint32_t draws = 0, matrices = 0;
        std::uint32_t last_block = 0;
        std::uint64_t matrix_seen = 0;
    };
    struct ProgramCamera {
        std::optional<Reading> reading;
        std::optional<Matrix> view;
        Matrix matrix{};         ///< that `reading` is of
        std::int64_t slot = -1;  ///< and where it stands
        UniformName view_name = UniformName::Unknown;
        std::uint64_t version = 0;
    };

    [[nodiscard]] const ProgramCamera* programCamera() const;
    [[nodiscard]] bool boundary();
    [[nodiscard]] bool inACorner() const;
    Group& groupOf(const Reading& reading);
    void viewOfFixed(Group& group) const;
    static void takeView(const Reading& reading, const Matrix& model_view, FoundCamera& camera);
    void countView(Group& group, std::uint64_t vertices) const;
    static void viewOfProgram(Group& group, const ProgramCamera& program);
    [[nodiscard]] const Group* mainGroup() const;
    [[nodiscard]] FoundCamera describe(const Group& group) const;
    void reject(const Reading& reading);
    void chooseTarget();

    TrackerRules rules_;
    bool mode_projection_ = false, mode_model_view_ = true;
    bool fixed_dirty_ = true, compiling_ = false, lists_change_projection_ = false;
    bool lists_change_mode_ = false;
    bool model_view_dirty_ = true;
    bool no_projection_ = false;  ///< the projection is the identity
    bool whole_ = false;          ///< `fixed_` is of both matrices together
    std::optional<Reading> fixed_;
    Matrix model_view_ = kIdentity;
    std::optional<Matrix> pushed_;
    std::size_t below_ = 0;  ///< levels of which nothing is known
    std::vector<Matrix> stack_;
    std::uint32_t pushes_ = 0;
    std::uint64_t fixed_version_ = 0;
    std::uint32_t program_ = 0, framebuffer_ = 0, target_ = 0;
    bool program_deleted_ = false;  ///< program_, which is in use still
    bool only_window_ = false;
    bool scene_seen_ = false;             ///< one that was no picture in a corner
    bool corner_seen_ = false;            ///< in this frame: such a picture that is taken for an overlay
    std::uint32_t frames_of_corner_ = 0;  ///< with such, since there was a scene
    std::function<double()> viewport_share_;
    DepthRules depth_;
    std::map<std::uint32_t, std::uint64_t>
        elsewhere_;  ///< vertices in perspective, by framebuffer other than the target
    std::set<std::uint32_t> refused_;
    std::map<std::uint32_t, ProgramCamera> programs_;

    std::vector<Group> groups_;
    std::uint32_t block_ = 0;
    bool scene_open_ = false, done_ = false;
    std::optional<std::uint32_t> learned_;
    std::optional<FoundCamera> kept_;
    FrameSummary now_, last_;
};

}  // namespace sluice::inject
