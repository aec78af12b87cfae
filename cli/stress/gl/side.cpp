// SPDX-License-Identifier: MIT
#include "stress/gl/side.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <optional>
#include <utility>

#include "compositor/gl_program.hpp"
#include "share/gl_errors.hpp"
#include "sluice/format.hpp"
#include "sluice/host_gl/context.hpp"
#include "stress/gl/fence_here.hpp"
#include "stress/gl/programs.hpp"
#include "stress/gl/slot.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::stress {
namespace {

constexpr std::uint32_t kGroup = 64;  ///< local_size_x of the compute program
constexpr GLuint kResultBinding = 4;
constexpr int kComputeVersion = 43;

}  // namespace

struct GlSide::State {
    explicit State(host::GlContext made) : context(std::move(made)) {}

    host::GlContext context;
    SluiceHostCapabilities capabilities{};
    Storage storage;
    std::optional<TurnProgram> program;
    std::vector<std::unique_ptr<GlSlot>> slots;
};

GlSide::GlSide(std::unique_ptr<State> state) : state_(std::move(state)) {}

GlSide::~GlSide() {
    clear();
    state_->program.reset();
}

Result<std::unique_ptr<GlSide>> GlSide::create() {
    auto context = host::GlContext::create();
    if (!context) {
        return context.error();
    }
    if (Status current = context.value().makeCurrent(); !current) {
        return current.error();
    }
    auto state = std::make_unique<State>(std::move(context).value());
    state->capabilities = host::queryCapabilities();
    return std::unique_ptr<GlSide>(new GlSide(std::move(state)));
}

const SluiceHostCapabilities& GlSide::capabilities() const {
    return state_->capabilities;
}

std::string GlSide::missingFor(Resource resource) const {
    const int version = epoxy_gl_version();
    if (version < 30) {
        return fmt::format("turns need OpenGL 3.0 (integers in GLSL), found {}.{}", version / 10, version % 10);
    }
    if (resource == Resource::Buffer && version < kComputeVersion) {
        return fmt::format("buffers need OpenGL 4.3 (compute), found {}.{}", version / 10, version % 10);
    }
    return {};
}

Status GlSide::allocate(const Storage& storage, std::vector<ExportedSlot> shared) {
    state_->slots.clear();
    if (!state_->program || state_->storage.resource != storage.resource) {
        auto program = TurnProgram::create(storage.resource);
        if (!program) {
            return program.error();
        }
        state_->program = std::move(program).value();
    }
    state_->storage = storage;
    for (std::uint32_t slot = 0; slot < storage.slots.count(); ++slot) {
        auto made = GlSlot::create(storage, slot, slot < shared.size() ? &shared[slot] : nullptr);
        if (!made) {
            return made.error();
        }
        state_->slots.push_back(std::move(made).value());
    }
    if (storage.resource == Resource::D32F) {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_ALWAYS);
    } else {
        glDisable(GL_DEPTH_TEST);
    }
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    const std::string errors = host::takeGlErrors();
    return errors.empty() ? Status{}
                          : Status{Error{SLUICE_ERROR_INTERNAL, "OpenGL side of the stress test", errors, ""}};
}

void GlSide::clear() {
    timeline_.reset();
    state_->slots.clear();
}

Status GlSide::makeTimeline(Backend backend, Topology topology, const SluiceRendererApi& api,
                            SluiceRenderer* renderer) {
    host::TimelineDeps deps;
    deps.api = &api;
    deps.renderer = renderer;
    if (backend == Backend::Bridged && topology == Topology::OneThread) {
        timeline_ = makeFenceHere(deps);
        return {};
    }
    auto made =
        host::makeHostTimeline(backend == Backend::Finish ? SLUICE_TIMELINE_FINISH : SLUICE_TIMELINE_BRIDGED, deps);
    if (!made) {
        return made.error();
    }
    timeline_ = std::move(made).value();
    return {};
}

void GlSide::run(const Turn& turn) {
    const State& s = *state_;
    const auto inputs = static_cast<std::uint32_t>(turn.inputs.size());
    s.program->use(turn.salt, inputs, s.storage.width, s.storage.texels());
    // Where no input is needed, something else that is readable: a slot must not be read while it is drawn into.
    const std::uint32_t other = s.storage.slots.own(turn.output == s.storage.slots.own(0) ? 1 : 0);
    const auto inputAt = [&](std::uint32_t j) -> const GlSlot& {
        return *s.slots[j < inputs ? turn.inputs[j] : other];
    };
    const GlSlot& output = *s.slots[turn.output];
    if (s.storage.resource == Resource::Buffer) {
        for (GLuint j = 0; j < kMaxInputs; ++j) {
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, j, inputAt(j).buffer());
        }
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kResultBinding, output.buffer());
        glDispatchCompute((s.storage.texels() + kGroup - 1) / kGroup, 1, 1);
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        return;
    }
    for (GLuint j = 0; j < kMaxInputs; ++j) {
        glActiveTexture(GL_TEXTURE0 + j);
        glBindTexture(GL_TEXTURE_2D, inputAt(j).texture());
    }
    glBindFramebuffer(GL_FRAMEBUFFER, output.framebuffer());
    glViewport(0, 0, static_cast<GLsizei>(s.storage.width), static_cast<GLsizei>(s.storage.height));
    host::drawScreenTriangle();
}

Result<std::vector<std::byte>> GlSide::read(std::uint32_t slot) {
    const State& s = *state_;
    std::vector<std::byte> texels(std::size_t{s.storage.texels()} * 4);
    if (s.storage.resource == Resource::Buffer) {
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, s.slots[slot]->buffer());
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(texels.size()), texels.data());
    } else {
        const FormatInfo& format = *findFormat(static_cast<std::uint32_t>(formatFor(s.storage.resource)));
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, s.slots[slot]->texture());
        glGetTexImage(GL_TEXTURE_2D, 0, format.gl_transfer_format, format.gl_transfer_type, texels.data());
    }
    const std::string errors = host::takeGlErrors();
    if (!errors.empty()) {
        return Error{SLUICE_ERROR_INTERNAL, "read-back of the stress test", "OpenGL raised " + errors, ""};
    }
    return texels;
}

}  // namespace sluice::stress
