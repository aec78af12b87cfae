// SPDX-License-Identifier: MIT
#include "payload/session.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sluice/host_gl/state_snapshot.hpp"
#include "tracker/refusal.hpp"

namespace sluice::inject {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kAuditedFrames = 8;          // with fluid; a full snapshot asks OpenGL thousands of questions
constexpr std::uint64_t kMostFailures = 120;         // frames in a row that may fail before a context is left alone
constexpr std::uint64_t kMostFailuresElsewhere = 3;  // before a framebuffer of the program's own is
constexpr std::uint64_t kFramesToTell = 2;           // after which a depth that was not used is not going to be
constexpr std::uint32_t kFramesToMove = 2;           // with the scene in a framebuffer, after which it has moved there
constexpr std::uint32_t kMostPrograms = 512;         // names that are looked at once, when the payload comes late
constexpr std::size_t kMostLeaks = 64;
constexpr std::uint32_t kMostDepthAsks = 64;   // draws of a frame before which a depth that is not used is asked for
constexpr std::uint32_t kMostBlockReads = 64;  // matrices of a frame that are read out of buffers

thread_local std::uint32_t kept_error = 0;

double seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

/// Adds the time of a scope.
class Timed {
  public:
    explicit Timed(double& sum) : sum_(sum) {}
    ~Timed() { sum_ += seconds(Clock::now() - begin_); }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;

  private:
    double& sum_;
    Clock::time_point begin_ = Clock::now();
};

UniformName meaningOf(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool view = name.find("view") != std::string::npos || name.find("camera") != std::string::npos;
    if (!view || name.find("proj") != std::string::npos || name.find("normal") != std::string::npos) {
        return UniformName::Unknown;
    }
    return name.find("model") != std::string::npos || name.find("world") != std::string::npos ? UniformName::ModelView
                                                                                              : UniformName::View;
}

}  // namespace

std::uint32_t takeKeptError() {
    return std::exchange(kept_error, GL_NO_ERROR);
}

void Spent::add(double s) {
    ++frames;
    seconds += s;
    most = std::max(most, s);
}

Session::Session(Payload& payload, const CurrentContext& current)
    : payload_(payload), identity_(current), tracker_(payload.settings.rules) {
    keepErrors();
    facts_ = contextFacts(payload.gl);
    GLint mode = GL_MODELVIEW;
    if (facts_.compatibility) {
        payload.gl.getIntegerv(GL_MATRIX_MODE, &mode);
    }
    tracker_.matrixMode(mode == GL_PROJECTION, mode == GL_MODELVIEW);
    GLint program = 0;
    payload.gl.getIntegerv(GL_CURRENT_PROGRAM, &program);
    tracker_.useProgram(static_cast<std::uint32_t>(program));
    GLint framebuffer = 0;
    payload.gl.getIntegerv(GL_FRAMEBUFFER_BINDING, &framebuffer);
    (void)tracker_.bindFramebuffer(static_cast<std::uint32_t>(framebuffer));
    tracker_.viewportBy([this] { return viewportShare(); });
    if (facts_.embedded) {
        tracker_.stayInTheWindow();  // what the own context shares with the program's
    }
    has_blocks_ = payload.settings.rules.route != CameraRoute::FixedFunction && hasUniformBlocks(payload.gl, facts_) &&
                  !(payload.settings.off && payload.settings.report.empty());
    askDepth();
    scanPrograms();
    forgetErrors(payload.gl);  // what an old context does not know of the above
}

/// Errors that the program has not asked for yet would be lost among ours.
void Session::keepErrors() {
    for (int i = 0; i < 8; ++i) {  // one flag per error kind; a lost context has no end of them
        const std::uint32_t error = payload_.gl.getError();
        if (error == GL_NO_ERROR) {
            return;
        }
        ++errors_;
        kept_error = kept_error == GL_NO_ERROR ? error : kept_error;
    }
}

/// The payload comes with the first swap, when a camera that never moves has long been uploaded.
void Session::scanPrograms() {
    const GlCalls& gl = payload_.gl;
    if (gl.isProgram == nullptr || gl.getProgramiv == nullptr || gl.getActiveUniform == nullptr ||
        gl.getUniformLocation == nullptr || gl.getUniformfv == nullptr) {
        return;
    }
    for (std::uint32_t program = 1; program <= kMostPrograms; ++program) {
        GLint linked = 0;
        GLint count = 0;
        if (gl.isProgram(program) == GL_FALSE) {
            continue;
        }
        gl.getProgramiv(program, GL_LINK_STATUS, &linked);
        gl.getProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
        for (GLint i = 0; linked != 0 && i < count; ++i) {
            std::array<char, 256> name{};
            GLint size = 0;
            GLenum type = 0;
            gl.getActiveUniform(program, static_cast<std::uint32_t>(i), 255, nullptr, &size, &type, name.data());
            const GLint location = type == GL_FLOAT_MAT4 ? gl.getUniformLocation(program, name.data()) : -1;
            if (location >= 0) {
                Matrix matrix{};
                gl.getUniformfv(program, location, matrix.data());
                tracker_.uniform(program, location, matrix, meaningOf(name.data()));
            }
        }
    }
}

UniformName Session::nameOf(std::uint32_t program, std::int32_t location) {
    const auto [known, fresh] = names_.try_emplace({program, location}, UniformName::Unknown);
    const GlCalls& gl = payload_.gl;
    if (!fresh || gl.getProgramiv == nullptr || gl.getActiveUniform == nullptr || gl.getUniformLocation == nullptr) {
        return known->second;
    }
    GLint count = 0;
    gl.getProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        std::array<char, 256> name{};
        GLint size = 0;
        GLenum type = 0;
        gl.getActiveUniform(program, static_cast<std::uint32_t>(i), 255, nullptr, &size, &type, name.data());
        if (type == GL_FLOAT_MAT4 && gl.getUniformLocation(program, name.data()) == location) {
            known->second = meaningOf(name.data());
        }
    }
    return known->second;
}

bool Session::clipsZeroToOne() const {
    GLint mode = GL_NEGATIVE_ONE_TO_ONE;
    if (facts_.clip_control) {
        payload_.gl.getIntegerv(GL_CLIP_DEPTH_MODE, &mode);
    }
    return mode == GL_ZERO_TO_ONE;
}

/// A program that neither tests nor clears a depth has one all the same, and nobody knows what is in it: the fluid
/// would be behind that.
void Session::clearUnusedDepth() {
    GLint tested = GL_FALSE;
    glGetIntegerv(GL_DEPTH_TEST, &tested);
    uses_depth_ = uses_depth_ || tested != GL_FALSE || tracker_.target() != 0;
    if (uses_depth_ || frames_ < kFramesToTell) {
        return;
    }
    ++depths_cleared_;
    GLboolean written = GL_TRUE;
    GLdouble value = 1.0;
    const GLboolean cut = glIsEnabled(GL_SCISSOR_TEST);
    glGetBooleanv(GL_DEPTH_WRITEMASK, &written);
    glGetDoublev(GL_DEPTH_CLEAR_VALUE, &value);
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glClearDepth(1.0);
    glClear(GL_DEPTH_BUFFER_BIT);
    glClearDepth(value);
    glDepthMask(written);
    if (cut != GL_FALSE) {
        glEnable(GL_SCISSOR_TEST);
    }
}

/// Once a frame: hardly a program changes its mind about it.
void Session::askDepth() {
    std::array<float, 2> range{0.0F, 1.0F};
    GLint function = GL_LESS;
    payload_.gl.getFloatv(GL_DEPTH_RANGE, range.data());
    payload_.gl.getIntegerv(GL_DEPTH_FUNC, &function);
    tracker_.depth({clipsZeroToOne(), range[0] > range[1], function == GL_GREATER || function == GL_GEQUAL});
    depth_asked_ = true;
    askDepthTest();
}

void Session::askDepthTest() {
    GLint tested = GL_FALSE;
    payload_.gl.getIntegerv(GL_DEPTH_TEST, &tested);
    uses_depth_ = uses_depth_ || tested != GL_FALSE;
}

void Session::forgetOldPrograms() {
    const std::uint64_t changes = payload_.programs_changed.load(std::memory_order_relaxed);
    if (std::exchange(programs_seen_, changes) != changes) {
        names_.clear();
        blocks_.clear();
    }
}

void Session::uniform(std::uint32_t program, std::int32_t location, const Matrix& matrix) {
    const std::uint32_t of = program != 0 ? program : tracker_.program();
    forgetOldPrograms();
    if (of != 0 && location >= 0) {
        tracker_.uniform(of, location, matrix, nameOf(of, location));
    }
}

/// At a draw, as the buffers stand then: a camera that was written through a mapping came by no call. What is read is
/// what OpenGL itself would read, so that no upload need be understood.
void Session::readBlocks() {
    const std::uint32_t program = tracker_.program();
    if (!has_blocks_ || !blocks_changed_ || program == 0 || block_reads_ >= kMostBlockReads) {
        return;
    }
    blocks_changed_ = false;
    forgetOldPrograms();
    const auto [known, fresh] = blocks_.try_emplace(program);
    if (!fresh && known->second.empty()) {
        return;
    }
    keepErrors();
    if (fresh) {
        known->second = blockMatrices(payload_.gl, program);
    }
    for (const BlockMatrix& where : known->second) {
        Matrix matrix{};
        ++block_reads_;
        if (readBlockMatrix(payload_.gl, facts_.embedded, program, where, matrix)) {
            const std::int64_t slot = (std::int64_t{where.block} + 1) << 32 | where.offset;
            tracker_.uniform(program, slot, matrix, meaningOf(where.name));
        }
    }
    forgetErrors(payload_.gl);
}

void Session::matrixPushed() {
    Matrix model_view = kIdentity;
    if (facts_.compatibility && tracker_.wantsPushedView()) {
        payload_.gl.getFloatv(GL_MODELVIEW_MATRIX, model_view.data());
    }
    tracker_.pushedView(model_view);
}

void Session::matrixModeUnknown() {
    if (facts_.compatibility && !tracker_.compiling()) {
        GLint mode = GL_MODELVIEW;
        payload_.gl.getIntegerv(GL_MATRIX_MODE, &mode);
        tracker_.matrixMode(mode == GL_PROJECTION, mode == GL_MODELVIEW);
    }
}

double Session::viewportShare() {
    if (!viewport_share_) {
        std::array<GLint, 4> viewport{};
        payload_.gl.getIntegerv(GL_VIEWPORT, viewport.data());
        const double whole = static_cast<double>(size_.width) * size_.height;
        viewport_share_ = whole > 0 ? static_cast<double>(viewport[2]) * viewport[3] / whole : 1.0;
    }
    return *viewport_share_;
}

void Session::listCalled() {
    viewport_share_.reset();
    if (tracker_.listsChangeMode()) {
        matrixModeUnknown();
    }
}

void Session::beforeDraw(std::uint32_t vertices) {
    if (ended_) {
        return;
    }
    if (!depth_asked_) {
        askDepth();
    }
    if (facts_.compatibility && tracker_.wantsMatrices()) {
        Matrix projection{};
        Matrix model_view{};
        payload_.gl.getFloatv(GL_PROJECTION_MATRIX, projection.data());
        payload_.gl.getFloatv(GL_MODELVIEW_MATRIX, model_view.data());
        tracker_.fixedMatrices(projection, model_view);
    }
    readBlocks();
    if (tracker_.draw(vertices)) {
        ++early_;
        composeNow();
    }
    if (!uses_depth_ && depth_asks_ < kMostDepthAsks && tracker_.inScene()) {
        ++depth_asks_;  // the first draws of a frame may be a sky, and the last ones an overlay
        askDepthTest();
    }
}

void Session::beforeClear(std::uint32_t mask) {
    uses_depth_ = uses_depth_ || (mask & GL_DEPTH_BUFFER_BIT) != 0;
    if (!ended_ && (mask & GL_DEPTH_BUFFER_BIT) != 0 && tracker_.clearsDepth()) {
        ++early_;
        composeNow();
    }
}

void Session::beforeClearOf(std::uint32_t framebuffer, std::uint32_t mask) {
    if (framebuffer == tracker_.framebuffer()) {
        beforeClear(mask);
    } else {
        uses_depth_ = uses_depth_ || (framebuffer == 0 && (mask & GL_DEPTH_BUFFER_BIT) != 0);
    }
}

void Session::beforeBind(std::uint32_t framebuffer) {
    if (tracker_.bindFramebuffer(framebuffer) && !ended_) {
        ++early_;
        composeNow();
    }
}

/// Into the default framebuffer, whatever is bound. A scene in another one has been read by now.
void Session::composeAtSwap() {
    if (tracker_.target() != 0 || passive()) {
        return;
    }
    if (facts_.embedded) {
        composeNow();  // in another context, which has the window bound
        return;
    }
    // GL's own word for it: a framebuffer that has been deleted is bound no more, and nobody told.
    GLint bound = 0;
    if (payload_.gl.bindFramebuffer != nullptr) {
        keepErrors();
        payload_.gl.getIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
        bound = payload_.gl.getError() == GL_NO_ERROR ? bound : 0;
    }
    if (bound != 0) {
        payload_.gl.bindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    }
    composeNow();
    if (bound != 0) {
        payload_.gl.bindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<std::uint32_t>(bound));
    }
}

void Session::swap(const CurrentContext& current, const char* route) {
    if (ended_) {
        return;
    }
    {
        const Timed timed(in_frame_);
        ++frames_;
        ++routes_[route];
        identity_.drawable = current.drawable;
        thread_ = std::this_thread::get_id();
        const DrawableSize size = drawableSize(payload_.gl, current);
        resizes_ += size_.width != 0 && !(size == size_) ? 1U : 0U;
        size_ = size;
    }
    if (!composed_) {
        composeAtSwap();
    }
    tracker_.endFrame();
    if (facts_.compatibility && tracker_.stackDepth() != 0) {
        // What pushes and pops nobody saw, or that failed, would add up.
        GLint depth = 1;
        payload_.gl.getIntegerv(GL_MODELVIEW_STACK_DEPTH, &depth);
        tracker_.stackIs(static_cast<std::size_t>(std::max(depth, 1) - 1));
    }
    composed_ = false;
    viewport_share_.reset();
    blocks_changed_ = true;
    depth_asked_ = false;
    block_reads_ = depth_asks_ = 0;
    if (water_ != nullptr) {
        const Timed timed(in_frame_);
        if (const Status status = beginWater(); !status) {
            giveUp(status.error().message());
        }
    }
    const std::string why = passive() || tracker_.camera() ? std::string() : noCamera(frames_, tracker_.lastFrame());
    if (!why.empty()) {
        (void)std::fprintf(stderr, "sluice inject: no fluid so far: %s\n", why.c_str());
    }
    spent_.add(std::exchange(in_frame_, 0.0));
}

double Session::time() const {
    return payload_.settings.step > 0 ? static_cast<double>(frames_) * payload_.settings.step
                                      : seconds(Clock::now().time_since_epoch());
}

bool Session::passive() const {
    return payload_.settings.off || !failure_.empty();
}

void Session::composeNow() {
    composed_ = true;
    std::optional<FoundCamera> camera = tracker_.camera();
    if (passive() || frames_ < payload_.settings.water.from_frame || !camera || size_.width == 0) {
        return;
    }
    const Timed timed(in_frame_);
    keepErrors();
    GLint buffer = GL_BACK;
    if (facts_.stereo) {
        payload_.gl.getIntegerv(GL_DRAW_BUFFER, &buffer);
    }
    if (const std::string why = refusal(*camera, {facts_.stereo, static_cast<std::uint32_t>(buffer)}); !why.empty()) {
        giveUp(why);
        return;
    }
    camera->zero_to_one = clipsZeroToOne();
    composeAudited(*camera);
}

void Session::composeAudited(const FoundCamera& camera) {
    // The state of a program of OpenGL ES is out of reach: everything is done in another context.
    const bool audit = payload_.settings.audit && audits_ < kAuditedFrames && !facts_.embedded;
    const host::StateSnapshot before = audit ? host::takeStateSnapshot() : host::StateSnapshot{};
    const Status status = compose(camera);
    if (!status && status.error().code == SLUICE_NOT_READY) {
        return;  // the renderer is being started
    }
    if (audit) {
        ++audits_;
        for (std::string& leak : host::differences(before, host::takeStateSnapshot())) {
            if (leaks_.size() < kMostLeaks) {
                leaks_.push_back(std::move(leak));
            }
        }
    }
    failed_in_a_row_ = status ? 0 : failed_in_a_row_ + 1;
    if (water_ != nullptr && tracker_.target() != 0 && failed_in_a_row_ >= kMostFailuresElsewhere) {
        tracker_.refuse(tracker_.target());
        failed_in_a_row_ = 0;
    }
    if (!status && (water_ == nullptr || failed_in_a_row_ > kMostFailures)) {
        giveUp(status.error().message());
    }
}

Status Session::compose(const FoundCamera& camera) {
    if (!facts_.embedded) {
        return composeIn(camera);
    }
    if (own_ == nullptr) {
        Result<std::unique_ptr<OwnContext>> made = OwnContext::create(payload_.gl, identity_);
        if (!made) {
            return made.error();
        }
        own_ = std::move(made).value();
    }
    const OwnContext::Turn turn(*own_);
    return turn.ok()
               ? composeIn(camera)
               : Status{Error{SLUICE_ERROR_UNSUPPORTED, "OpenGL ES", "the program draws to a surface of another kind",
                              "run a program of desktop OpenGL"}};
}

Status Session::beginWater() {
    std::optional<OwnContext::Turn> turn;
    if (own_ != nullptr) {
        turn.emplace(*own_);
    }
    return water_->begin(time());
}

Status Session::composeIn(const FoundCamera& camera) {
    clearUnusedDepth();
    if (water_ == nullptr) {
        Result<std::unique_ptr<Water>> made =
            createWater(payload_.folder, payload_.settings, camera, seenDistance(camera));
        if (!made) {
            return made.error();
        }
        water_ = std::move(made).value();
        placed_in_own_ = tracker_.target() != 0;
        if (Status status = water_->begin(time()); !status) {
            return status;
        }
    }
    // What came before was a menu, or a picture in a corner. The other way round it is not so: whoever draws its scene
    // in a framebuffer shows a menu in the window, and goes on thereafter with the water as it was.
    moved_ = !placed_in_own_ && tracker_.target() != 0 && tracker_.sceneSeen() ? moved_ + 1 : 0;
    if (moved_ >= kFramesToMove) {
        placed_in_own_ = true;
        if (Status status = water_->placeAnew(camera, seenDistance(camera)); !status) {
            return status;
        }
    }
    return water_->compose(camera, time());
}

/// Whether one pixel of depth that is read is one float, and the one that the buffer holds.
bool Session::readsPlainly() const {
    for (const std::uint32_t name :
         std::array<std::uint32_t, 3>{GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES}) {
        GLint value = 0;
        payload_.gl.getIntegerv(name, &value);
        if (value != 0) {
            return false;
        }
    }
    float scale = 1.0F;
    float bias = 0.0F;
    if (facts_.compatibility) {
        payload_.gl.getFloatv(GL_DEPTH_SCALE, &scale);
        payload_.gl.getFloatv(GL_DEPTH_BIAS, &bias);
    }
    return scale == 1.0F && bias == 0.0F;
}

/// The median distance of what the eye sees, from a grid of depths of the frame; 0 if it sees nothing.
double Session::seenDistance(const FoundCamera& camera) const {
    constexpr int kAcross = 9;
    GLint read = 0;
    GLint buffer = 0;
    payload_.gl.getIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read);
    payload_.gl.getIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer);
    if (buffer != 0 || static_cast<std::uint32_t>(read) != tracker_.target() || !readsPlainly()) {
        return 0.0;  // what is read would go elsewhere, or come from there
    }
    std::vector<double> distances;
    for (int y = 0; y < kAcross; ++y) {
        for (int x = 0; x < kAcross; ++x) {
            float depth = 1.0F;
            const auto at = [](int i, std::uint32_t size) {
                return static_cast<GLint>((static_cast<double>(i) + 0.5) / kAcross * size);
            };
            payload_.gl.readPixels(at(x, size_.width), at(y, size_.height), 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
            if (depth > 0.0F && depth < 1.0F) {
                const double n = camera.lens.near_plane;
                const double f = camera.lens.far_plane;
                distances.push_back(n * f / (f - double{depth} * (f - n)));
            }
        }
    }
    forgetErrors(payload_.gl);  // a framebuffer of several samples, for one
    if (distances.empty()) {
        return 0.0;
    }
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                     distances.end());
    return distances[distances.size() / 2];
}

void Session::giveUp(const std::string& why) {
    if (failure_.empty()) {
        failure_ = why;
        const std::string because = wasSaid(why) ? "" : ": " + why;
        (void)std::fprintf(stderr, "sluice inject: no more fluid in this context%s\n", because.c_str());
    }
    endWater();
}

void Session::end() {
    endWater();
}

void Session::endWater() {
    if (water_ != nullptr) {
        last_water_ = water();
        std::optional<OwnContext::Turn> turn;
        if (own_ != nullptr) {
            turn.emplace(*own_);
        }
        water_.reset();
    }
    own_.reset();
}

WaterReport Session::water() {
    std::optional<OwnContext::Turn> turn;
    if (own_ != nullptr) {
        turn.emplace(*own_);
    }
    return water_ != nullptr ? water_->report() : last_water_;
}

}  // namespace sluice::inject
