// SPDX-License-Identifier: MIT
#include "tracker/frame_tracker.hpp"

#include <algorithm>
#include <utility>

namespace sluice::inject {

namespace {

// Nobody knows what is in a display list or between glBegin and glEnd; a list stands for a mesh.
constexpr std::uint64_t kUnknownVertices = 24;
constexpr std::size_t kMostLenses = 16;
constexpr std::uint32_t kMostPushes = 512;  // of a frame, that are asked for their matrix
constexpr std::size_t kMostLevels = 64;     // OpenGL has 32 at least, and seldom more
constexpr std::size_t kMostReasons = 16;
constexpr std::uint32_t kOldScene = 120;  // frames with a picture in a corner and no scene, after which it is one
constexpr double kCorner = 0.15;  // of the window: a face or a map beside the scene; a quarter may be one player's

}  // namespace

void FrameTracker::matrixMode(bool projection, bool model_view) {
    mode_projection_ = projection;
    mode_model_view_ = model_view;
    lists_change_mode_ = lists_change_mode_ || compiling_;
}

void FrameTracker::matrixChanged() {
    if (!mode_projection_) {
        model_view_dirty_ = model_view_dirty_ || (mode_model_view_ && !compiling_);
        return;
    }
    if (compiling_) {
        lists_change_projection_ = true;
    } else {
        fixed_dirty_ = true;
        pushed_.reset();
    }
}

void FrameTracker::compileList(bool compiling) {
    compiling_ = compiling;
}

bool FrameTracker::wantsPushedView() const {
    return mode_model_view_ && !compiling_ && framebuffer_ == target_ && pushes_ < kMostPushes;
}

void FrameTracker::pushedView(const Matrix& model_view) {
    if (!mode_model_view_ || compiling_) {
        return;
    }
    ++pushes_;
    if (fixed_dirty_) {
        pushed_ = model_view;
    }
    if (stack_.size() < kMostLevels) {
        stack_.push_back(model_view);
    } else {
        stackIs(stackDepth() + 1);
    }
}

void FrameTracker::stackIs(std::size_t depth) {
    if (depth != stackDepth()) {
        stack_.clear();
        below_ = depth;
    }
}

void FrameTracker::popped() {
    if (mode_model_view_ && !compiling_) {
        if (!stack_.empty()) {
            stack_.pop_back();
        } else if (below_ > 0) {
            --below_;
        }
    }
    matrixChanged();
}

/// A camera is what everything is drawn on top of: the lowest matrix of the stack that is not the identity.
void FrameTracker::countView(Group& group, std::uint64_t vertices) const {
    const auto lowest = std::find_if(stack_.begin(), stack_.end(), [](const Matrix& m) { return !isIdentity(m); });
    if (lowest == stack_.end()) {
        return;
    }
    for (Candidate& candidate : group.views) {
        if (candidate.matrix == *lowest) {
            candidate.vertices += vertices;
            return;
        }
    }
    if (group.views.size() < kMostLenses) {
        group.views.push_back({*lowest, vertices});
    }
}

const FrameTracker::ProgramCamera* FrameTracker::programCamera() const {
    if (program_ == 0 || rules_.route == CameraRoute::FixedFunction) {
        return nullptr;
    }
    const auto found = programs_.find(program_);
    return found != programs_.end() && found->second.reading ? &found->second : nullptr;
}

bool FrameTracker::wantsMatrices() const {
    const bool changed = fixed_dirty_ || (no_projection_ && model_view_dirty_);
    return changed && !compiling_ && rules_.route != CameraRoute::Uniforms && programCamera() == nullptr;
}

void FrameTracker::fixedMatrices(const Matrix& projection, const Matrix& model_view) {
    fixed_dirty_ = lists_change_projection_;
    model_view_dirty_ = false;
    model_view_ = model_view;
    fixed_ = readMatrix(projection, depth_);
    // A program that never says glMatrixMode has gluPerspective in its model-view matrix: at each draw the two together
    // are what counts.
    no_projection_ = isIdentity(projection);
    whole_ = false;
    if (fixed_->shape == Shape::Flat) {
        if (Reading both = readMatrix(product(projection, model_view), depth_); both.shape == Shape::Perspective) {
            fixed_ = std::move(both);
            whole_ = true;
        }
    }
    ++fixed_version_;
    reject(*fixed_);
}

void FrameTracker::depth(const DepthRules& rules) {
    if (depth_ == rules) {
        return;
    }
    depth_ = rules;
    fixed_dirty_ = true;
    for (auto& [program, camera] : programs_) {
        if (camera.reading) {  // of a matrix that is written once
            camera.reading = readEitherWay(camera.matrix, rules);
        }
    }
}

void FrameTracker::useProgram(std::uint32_t program) {
    if (program_deleted_ && program != program_) {
        programs_.erase(program_);
        program_deleted_ = false;
    }
    program_ = program;
}

void FrameTracker::programDeleted(std::uint32_t program) {
    if (program == program_) {
        program_deleted_ = program != 0;
    } else {
        programs_.erase(program);
    }
}

void FrameTracker::uniform(std::uint32_t program, std::int64_t slot, const Matrix& matrix, UniformName name) {
    ProgramCamera& camera = programs_[program != 0 ? program : program_];
    if (camera.reading && camera.slot == slot && camera.matrix == matrix) {
        return;
    }
    Reading reading = readEitherWay(matrix, depth_);
    const bool was_camera = camera.reading && camera.slot == slot;
    if (reading.shape == Shape::Perspective || (was_camera && reading.shape == Shape::Flat)) {
        camera.reading = std::move(reading);
        camera.matrix = matrix;
        camera.slot = slot;
        ++camera.version;
        return;
    }
    if (name == UniformName::View || (name == UniformName::ModelView && camera.view_name != UniformName::View)) {
        // Of a rigid motion only one of the two is affine, unless it is a turn alone, which goes as the projection
        // does.
        const bool turn = matrix[3] == 0 && matrix[7] == 0 && matrix[11] == 0;
        const bool by_rows = camera.reading && camera.reading->transposed;
        const Matrix& view =
            turn && !(by_rows && matrix[12] == 0 && matrix[13] == 0 && matrix[14] == 0) ? matrix : transposed(matrix);
        if (rigidPart(view).valid) {
            camera.view = view;
            camera.view_name = name == UniformName::View ? UniformName::View : camera.view_name;
            return;
        }
    }
    reject(reading);
}

void FrameTracker::reject(const Reading& reading) {
    if (reading.shape != Shape::Rejected) {
        return;
    }
    const auto found = now_.rejected.find(reading.reason);
    if (found != now_.rejected.end()) {
        ++found->second;
    } else if (now_.rejected.size() < kMostReasons) {
        now_.rejected.emplace(reading.reason, 1);
    }
}

FrameTracker::Group& FrameTracker::groupOf(const Reading& reading) {
    for (Group& group : groups_) {
        if (sameLens(group.reading.lens, reading.lens)) {
            return group;
        }
    }
    if (groups_.size() < kMostLenses) {
        groups_.emplace_back();
    }
    Group& group = groups_.back();
    group = Group{};
    group.reading = reading;
    return group;
}

void FrameTracker::viewOfFixed(Group& group) const {
    FoundCamera& camera = group.camera;
    if (whole_) {
        camera.source = "perspective in the model-view matrix";
        camera.confidence = 0.8;
        camera.view = group.reading.view;
        camera.scale = group.reading.scale;
        camera.view_source = "what stands right of the perspective in the first draw";
        camera.view_confidence = 0.5;
        return;
    }
    const bool use_pushed =
        pushed_ && (rules_.view == ViewRule::Pushed || (rules_.view == ViewRule::Automatic && !isIdentity(*pushed_)));
    camera.source = group.reading.pure ? "projection matrix" : "projection matrix that holds the view, too";
    camera.confidence = group.reading.pure ? 0.95 : 0.85;
    camera.view_source =
        use_pushed ? "model-view matrix at the push before the first draw" : "model-view matrix at the first draw";
    camera.view_confidence = use_pushed ? 0.7 : 0.6;
    takeView(group.reading, use_pushed ? *pushed_ : model_view_, camera);
}

void FrameTracker::takeView(const Reading& reading, const Matrix& model_view, FoundCamera& camera) {
    const Rigid rigid = rigidPart(model_view);
    if (!rigid.valid) {
        camera.view = reading.view;
        camera.view_source = "none: the model-view matrix is not rigid";
        camera.view_confidence = 0.1;
        return;
    }
    camera.view = product(reading.view, reading.left_handed ? otherHanded(rigid.matrix) : rigid.matrix);
    camera.scale = reading.scale * rigid.scale;
    if (isIdentity(camera.view)) {
        camera.view_confidence = 0.3;
    }
}

void FrameTracker::viewOfProgram(Group& group, const ProgramCamera& program) {
    FoundCamera& camera = group.camera;
    camera.source = group.reading.pure ? "uniform: projection" : "uniform: projection with model or view";
    camera.confidence = group.reading.pure ? 0.9 : 0.6;
    camera.view = group.reading.view;
    camera.scale = group.reading.scale;
    camera.view_source = group.reading.pure ? "none" : "what stands right of the projection in the first draw";
    camera.view_confidence = group.reading.pure ? 0.1 : 0.5;
    if (const Rigid rigid = program.view ? rigidPart(*program.view) : Rigid{}; rigid.valid && group.reading.pure) {
        camera.view = group.reading.left_handed ? otherHanded(rigid.matrix) : rigid.matrix;
        camera.scale = rigid.scale;
        const bool named = program.view_name == UniformName::View;
        camera.view_source = named ? "uniform named view" : "uniform named model-view at the first draw";
        camera.view_confidence = named ? 0.8 : 0.5;
    }
}

bool FrameTracker::inACorner() const {
    return framebuffer_ == 0 && viewport_share_ && viewport_share_() < kCorner;
}

bool FrameTracker::draw(std::uint32_t vertices) {
    if (compiling_) {
        return false;
    }
    const std::uint64_t count = vertices == 0 ? kUnknownVertices : vertices;
    const ProgramCamera* program = programCamera();
    const bool may_use_fixed = program == nullptr && rules_.route != CameraRoute::Uniforms && fixed_;
    const Reading* reading = program != nullptr ? &*program->reading : may_use_fixed ? &*fixed_ : nullptr;
    const bool perspective = reading != nullptr && reading->shape == Shape::Perspective;
    if (framebuffer_ != target_) {
        ++now_.foreign_draws;
        if (perspective && refused_.count(framebuffer_) == 0) {
            if (inACorner()) {
                corner_seen_ = true;
            } else {
                elsewhere_[framebuffer_] += count;
            }
        }
        return false;
    }
    if (!perspective) {
        ++now_.flat_draws;
        return boundary();
    }
    const bool small = inACorner();
    if (small && (scene_seen_ || !elsewhere_.empty())) {
        corner_seen_ = true;
        ++now_.flat_draws;
        return boundary();
    }
    Group& group = groupOf(*reading);
    group.small = small && (group.draws == 0 || group.small);  // a face may have the level's own lens
    const std::uint64_t version = program != nullptr ? program->version : fixed_version_;
    if (group.draws == 0) {
        if (program != nullptr) {
            viewOfProgram(group, *program);
        } else {
            group.fixed = true;
            viewOfFixed(group);
        }
    }
    if (group.fixed && !whole_ && rules_.view == ViewRule::Automatic) {
        countView(group, count);
    }
    if (group.matrix_seen != version) {
        group.matrix_seen = version;
        ++group.matrices;
    }
    group.vertices += count;
    ++group.draws;
    group.last_block = block_;
    scene_open_ = true;
    return false;
}

bool FrameTracker::clearsDepth() {
    return framebuffer_ == target_ && !compiling_ && boundary();
}

bool FrameTracker::bindFramebuffer(std::uint32_t framebuffer) {
    // A scene in the default framebuffer may go on after a look elsewhere; one in a framebuffer of the program's own is
    // about to be read.
    const bool leaves = framebuffer_ != 0 && framebuffer_ == target_ && framebuffer != target_;
    const bool now = leaves && boundary();
    framebuffer_ = framebuffer;
    return now;
}

void FrameTracker::framebufferDeleted(std::uint32_t framebuffer) {
    if (framebuffer == 0) {
        return;
    }
    framebuffer_ = framebuffer_ == framebuffer ? 0 : framebuffer_;
    elsewhere_.erase(framebuffer);
    refused_.erase(framebuffer);
    if (target_ == framebuffer) {
        target_ = 0;
        learned_.reset();
    }
}

void FrameTracker::refuse(std::uint32_t framebuffer) {
    refused_.insert(framebuffer);
    if (target_ == framebuffer) {
        target_ = 0;
        learned_.reset();
    }
}

/// The default framebuffer if any scene is drawn there.
void FrameTracker::chooseTarget() {
    const Group* const most = mainGroup();
    const bool whole = !elsewhere_.empty() || (most != nullptr && !most->small);
    scene_seen_ = scene_seen_ || whole;
    frames_of_corner_ = whole ? 0 : frames_of_corner_ + (corner_seen_ ? 1U : 0U);
    corner_seen_ = false;
    if (frames_of_corner_ >= kOldScene) {  // what filled the window was an intro, and this is what it was for
        scene_seen_ = false;
        frames_of_corner_ = 0;
        if (target_ != 0) {
            target_ = 0;
            learned_.reset();
        }
    }
    const bool here = most != nullptr && (!most->small || elsewhere_.empty());
    const bool in_default = target_ == 0 ? here : elsewhere_.count(0) != 0;
    std::uint32_t next = target_;
    if (in_default) {
        next = 0;
    } else if (!here && !elsewhere_.empty() && !only_window_) {
        next = std::max_element(elsewhere_.begin(), elsewhere_.end(), [](const auto& a, const auto& b) {
                   return a.second < b.second;
               })->first;
    }
    if (next != target_) {
        target_ = next;
        learned_.reset();
    }
    elsewhere_.clear();
}

bool FrameTracker::boundary() {
    if (!scene_open_) {
        return false;
    }
    scene_open_ = false;
    ++now_.switches;
    const std::uint32_t block = block_++;
    const bool now = rules_.overlay == OverlaySwitch::First ||
                     (rules_.overlay == OverlaySwitch::Automatic && learned_ && *learned_ == block);
    if (!now || done_) {
        return false;
    }
    done_ = true;
    now_.composited_early = true;
    return true;
}

const FrameTracker::Group* FrameTracker::mainGroup() const {
    const auto most = std::max_element(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
        return a.small != b.small ? a.small : a.vertices < b.vertices;
    });
    return most == groups_.end() ? nullptr : &*most;
}

FoundCamera FrameTracker::describe(const Group& group) const {
    FoundCamera found = group.camera;
    found.lens = group.reading.lens;
    found.vertices = group.vertices;
    const auto most = std::max_element(group.views.begin(), group.views.end(),
                                       [](const Candidate& a, const Candidate& b) { return a.vertices < b.vertices; });
    if (most != group.views.end() && 2 * most->vertices >= group.vertices && rigidPart(most->matrix).valid) {
        found.view_source = "lowest model-view matrix on the stack";
        found.view_confidence = 0.5 + 0.4 * static_cast<double>(most->vertices) / static_cast<double>(group.vertices);
        takeView(group.reading, most->matrix, found);
    }
    if (!group.reading.pure && group.matrices > 1 && found.confidence < 0.85) {
        // Matrices of several objects that agree on one lens are no accident.
        found.confidence += 0.08 * std::min(3U, group.matrices - 1);
    }
    std::uint64_t all = 0;
    for (const Group& other : groups_) {
        all += other.vertices;
    }
    found.confidence *=
        0.5 + 0.5 * static_cast<double>(group.vertices) / static_cast<double>(std::max<std::uint64_t>(all, 1));
    if (rules_.near_plane || rules_.far_plane) {
        found.lens.near_plane = rules_.near_plane.value_or(found.lens.near_plane);
        found.lens.far_plane = rules_.far_plane.value_or(found.lens.far_plane);
        found.source += ", planes by the profile";
    }
    if (rules_.view == ViewRule::Identity) {
        found.view = kIdentity;
        found.view_source = "none, by the profile";
        found.view_confidence = 1.0;
    }
    return found;
}

std::optional<FoundCamera> FrameTracker::camera() const {
    const Group* group = mainGroup();
    return group != nullptr ? describe(*group) : kept_;
}

void FrameTracker::endFrame() {
    if (const Group* group = mainGroup(); group != nullptr) {
        kept_ = describe(*group);
        // Ended by an overlay, or by the swap? The next frame is expected to do the same.
        learned_ = group->last_block < block_ ? std::optional(group->last_block) : std::nullopt;
    }
    for (const Group& group : groups_) {
        now_.lenses.push_back({group.reading.lens, group.camera.source, group.vertices, group.draws, group.matrices});
    }
    now_.target = target_;
    chooseTarget();
    last_ = std::exchange(now_, FrameSummary{});
    now_.rejected = last_.rejected;
    groups_.clear();
    block_ = 0;
    scene_open_ = done_ = false;
    fixed_dirty_ = true;  // the model-view of the next frame's first draw is another one
    pushed_.reset();
    pushes_ = 0;
}

}  // namespace sluice::inject
