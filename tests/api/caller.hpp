// SPDX-License-Identifier: MIT
// An engine as libsluice.so meets it: a context of some version and profile, a framebuffer, a room with a wall.
#pragma once

#include <epoxy/gl.h>
// After epoxy/gl.h, which must be the first to declare OpenGL.
#include <epoxy/egl.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sluice/sluice.h"

namespace sluice::test {

inline constexpr GLsizei kWidth = 96;
inline constexpr GLsizei kHeight = 64;

struct Version {
    int major = 2, minor = 1;
    bool core = false;
};

/// What the window is like, where there is one.
struct Window {
    EGLint width = kWidth, height = kHeight;
    EGLint samples = 0;
    bool srgb = false;
};

/// An EGL context of Mesa's surfaceless platform, current on this thread while it lives; with a pbuffer for a window if
/// one is asked for.
class EglCaller {
  public:
    explicit EglCaller(const Version& version, const std::optional<Window>& window = std::nullopt);
    ~EglCaller();
    EglCaller(const EglCaller&) = delete;
    EglCaller& operator=(const EglCaller&) = delete;
    [[nodiscard]] bool ok() const { return context_ != EGL_NO_CONTEXT; }
    /// Another window in the place of the first, as one that has been resized.
    void resize(EGLint width, EGLint height);
    void makeCurrent() const;
    /// The engine's own end of the context, while a Sluice still lives in it.
    void destroyContext();

  private:
    [[nodiscard]] EGLSurface makeSurface(EGLint width, EGLint height) const;

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLConfig config_ = EGL_NO_CONFIG_KHR;
    EGLSurface surface_ = EGL_NO_SURFACE;
    EGLContext context_ = EGL_NO_CONTEXT;
    bool srgb_ = false;
};

struct Formats {
    GLenum colour = GL_RGBA8, depth = GL_DEPTH24_STENCIL8;
    GLsizei samples = 0;
};

/// A framebuffer object of renderbuffers, bound while nobody binds another.
class Buffers {
  public:
    Buffers(GLsizei width, GLsizei height, const Formats& formats);
    ~Buffers();
    Buffers(const Buffers&) = delete;
    Buffers& operator=(const Buffers&) = delete;
    void bind() const;
    [[nodiscard]] GLuint name() const { return framebuffer_; }

  private:
    GLuint framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

/// Clears to a dark green at the far plane, and puts a red wall, near enough to hide all fluid, over the left third:
/// with scissored clears, which every profile has.
void drawRoom(GLsizei width = kWidth, GLsizei height = kHeight);

/// The pixels of what is bound for drawing, resolved, RGBA8 from the bottom up.
[[nodiscard]] std::vector<std::uint8_t> pixels(GLuint framebuffer, GLsizei width = kWidth, GLsizei height = kHeight);

/// How many pixels of the columns [from, to) differ.
[[nodiscard]] int changed(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after, GLsizei from,
                          GLsizei to, GLsizei width = kWidth, GLsizei height = kHeight);

/// A camera 4 m before the origin at a height of half a metre, 60 degrees wide.
struct Camera {
    std::array<float, 16> view, projection;
};
[[nodiscard]] Camera camera(float aspect = 1.5F);

/// Lines that the log brought at WARNING and above.
struct Log {
    std::vector<std::string> lines;
    static void callback(void* user, std::int32_t level, const char* message);
};

/// Options with that log.
[[nodiscard]] SluiceOptions options(Log& log, std::uint32_t process, std::uint32_t width = kWidth,
                                    std::uint32_t height = kHeight);
/// A block of fluid in the middle, without gravity, of some 500 particles: it stays where it is.
[[nodiscard]] SluiceResult pour(Sluice* fluid);

/// begin, draw, end; the result of the end.
SluiceResult frame(Sluice* fluid, double time, GLsizei width = kWidth, GLsizei height = kHeight);

}  // namespace sluice::test
