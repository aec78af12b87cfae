// SPDX-License-Identifier: MIT
#include "caller.hpp"

#include <algorithm>
#include <cmath>

namespace sluice::test {

EglCaller::EglCaller(const Version& version, const std::optional<Window>& window) {
    display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    eglInitialize(display_, nullptr, nullptr);
    eglBindAPI(EGL_OPENGL_API);
    if (window) {
        const std::array<EGLint, 13> wanted{EGL_SURFACE_TYPE,
                                            EGL_PBUFFER_BIT,
                                            EGL_RENDERABLE_TYPE,
                                            EGL_OPENGL_BIT,
                                            EGL_DEPTH_SIZE,
                                            24,
                                            EGL_SAMPLES,
                                            window->samples,
                                            EGL_ALPHA_SIZE,
                                            8,
                                            EGL_SAMPLE_BUFFERS,
                                            window->samples > 0 ? 1 : 0,
                                            EGL_NONE};
        EGLint count = 0;
        if (eglChooseConfig(display_, wanted.data(), &config_, 1, &count) != EGL_TRUE || count == 0) {
            return;
        }
        srgb_ = window->srgb;
        surface_ = makeSurface(window->width, window->height);
    }
    const std::array<EGLint, 7> asked{
        EGL_CONTEXT_MAJOR_VERSION,
        version.major,
        EGL_CONTEXT_MINOR_VERSION,
        version.minor,
        EGL_CONTEXT_OPENGL_PROFILE_MASK,
        version.core ? EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT : EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
        EGL_NONE};
    context_ = eglCreateContext(display_, config_, EGL_NO_CONTEXT, asked.data());
    makeCurrent();
}

EGLSurface EglCaller::makeSurface(EGLint width, EGLint height) const {
    const std::array<EGLint, 7> asked{EGL_WIDTH,         width,
                                      EGL_HEIGHT,        height,
                                      EGL_GL_COLORSPACE, srgb_ ? EGL_GL_COLORSPACE_SRGB : EGL_GL_COLORSPACE_LINEAR,
                                      EGL_NONE};
    return eglCreatePbufferSurface(display_, config_, asked.data());
}

void EglCaller::resize(EGLint width, EGLint height) {
    EGLSurface old = surface_;
    surface_ = makeSurface(width, height);
    makeCurrent();
    eglDestroySurface(display_, old);
}

void EglCaller::makeCurrent() const {
    if (ok()) {
        eglMakeCurrent(display_, surface_, surface_, context_);
    }
}

void EglCaller::destroyContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (ok()) {
        eglDestroyContext(display_, context_);
    }
    context_ = EGL_NO_CONTEXT;
}

EglCaller::~EglCaller() {
    destroyContext();
    if (surface_ != EGL_NO_SURFACE) {
        eglDestroySurface(display_, surface_);
    }
}

Buffers::Buffers(GLsizei width, GLsizei height, const Formats& formats) {
    const auto storage = [&](GLenum format) {
        GLuint name = 0;
        glGenRenderbuffers(1, &name);
        glBindRenderbuffer(GL_RENDERBUFFER, name);
        if (formats.samples > 0) {
            glRenderbufferStorageMultisample(GL_RENDERBUFFER, formats.samples, format, width, height);
        } else {
            glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
        }
        return name;
    };
    colour_ = storage(formats.colour);
    depth_ = storage(formats.depth);
    glGenFramebuffers(1, &framebuffer_);
    bind();
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    const bool packed = formats.depth == GL_DEPTH24_STENCIL8 || formats.depth == GL_DEPTH32F_STENCIL8;
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, packed ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
                              GL_RENDERBUFFER, depth_);
}

Buffers::~Buffers() {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(1, &colour_);
    glDeleteRenderbuffers(1, &depth_);
}

void Buffers::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
}

void drawRoom(GLsizei width, GLsizei height) {
    glDisable(GL_SCISSOR_TEST);
    glClearColor(0.1F, 0.3F, 0.1F, 1.0F);
    glClearDepth(1.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, width / 3, height);
    glClearColor(0.8F, 0.1F, 0.1F, 1.0F);
    glClearDepth(0.5);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    glClearDepth(1.0);
}

std::vector<std::uint8_t> pixels(GLuint framebuffer, GLsizei width, GLsizei height) {
    std::vector<std::uint8_t> found(static_cast<std::size_t>(width * height) * 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    GLint samples = 0;
    glGetIntegerv(GL_SAMPLES, &samples);
    if (framebuffer != 0 && samples > 0) {
        const Buffers resolved(width, height, {});
        glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
        glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved.name());
        glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, found.data());
    } else {
        glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, found.data());
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    return found;
}

int changed(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after, GLsizei from, GLsizei to,
            GLsizei width, GLsizei height) {
    int count = 0;
    for (GLsizei y = 0; y < height; ++y) {
        for (GLsizei x = from; x < to; ++x) {
            const auto at = static_cast<std::ptrdiff_t>(y * width + x) * 4;
            count += std::equal(before.begin() + at, before.begin() + at + 4, after.begin() + at) ? 0 : 1;
        }
    }
    return count;
}

Camera camera(float aspect) {
    constexpr float kNear = 0.1F;
    constexpr float kFar = 100.0F;
    const float scale = 1.0F / std::tan(0.5235988F);
    return {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.5F, -4.0F, 1},
            {scale / aspect, 0, 0, 0, 0, scale, 0, 0, 0, 0, (kFar + kNear) / (kNear - kFar), -1, 0, 0,
             2.0F * kFar * kNear / (kNear - kFar), 0}};
}

void Log::callback(void* user, std::int32_t level, const char* message) {
    if (level >= SLUICE_LOG_WARNING) {
        static_cast<Log*>(user)->lines.emplace_back(message);
    }
}

SluiceOptions options(Log& log, std::uint32_t process, std::uint32_t width, std::uint32_t height) {
    SluiceOptions options{};
    sluice_options_defaults(&options, sizeof(options));
    options.width = width;
    options.height = height;
    options.process = process;
    options.log = Log::callback;
    options.log_user = &log;
    return options;
}

SluiceResult pour(Sluice* fluid) {
    SluiceWater water{};
    sluice_water_defaults(&water, sizeof(water));
    water.radius = 0.1F;
    for (const std::size_t axis : {0U, 1U, 2U}) {
        water.low[axis] = -2.0F;
        water.high[axis] = 2.0F;
        water.gravity[axis] = 0.0F;
    }
    SluiceBlock block{};
    for (const std::size_t axis : {0U, 1U, 2U}) {
        block.low[axis] = axis == 0 ? -1.6F : -0.5F;
        block.high[axis] = axis == 0 ? 1.6F : 0.5F;
    }
    water.blocks = &block;
    water.block_count = 1;
    return sluice_set_water(fluid, &water);
}

SluiceResult frame(Sluice* fluid, double time, GLsizei width, GLsizei height) {
    const Camera eye = camera(static_cast<float>(width) / static_cast<float>(height));
    static_cast<void>(sluice_begin_frame(fluid, eye.view.data(), eye.projection.data(), time));
    drawRoom(width, height);
    return sluice_end_frame(fluid);
}

}  // namespace sluice::test
