// SPDX-License-Identifier: MIT
// The state of a host that a screen-filling quad of ours must not disturb, nor be disturbed by.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <cstddef>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::host {

/// An error if GL is in a state in which nothing can be drawn or queried without damage to the host: a display list
/// being compiled, or selection or feedback mode, neither of which core profiles have. (glBegin/glEnd, conditional
/// rendering and an active occlusion query cannot be told in OpenGL; calling there is a broken contract.)
[[nodiscard]] Status checkDrawable();

/// Saves every state that decides how a triangle without vertex arrays is rasterised and written to draw buffer 0, and
/// sets it so that each covered pixel of the framebuffer runs the fragment shader once: no culling, clipping, scissor,
/// stencil, alpha or depth test, blending, masks or feedback. The destructor puts it back.
///
/// State is read and written back one by one, not with glPushAttrib: the host's attribute stack may be full, and it
/// covers neither indexed state (viewport arrays, per-buffer blending) nor anything later than OpenGL 2.1. Where OpenGL
/// has indexed state only index 0 is touched.
class DrawGuard {
  public:
    DrawGuard(GLsizei width, GLsizei height);
    ~DrawGuard();
    DrawGuard(const DrawGuard&) = delete;
    DrawGuard& operator=(const DrawGuard&) = delete;

  private:
    struct Toggle {
        GLenum name;
        bool was_on;
    };
    struct Features {
        bool indexed_masks, indexed_blend, viewport_arrays, feedback_objects, clip_control, clamp_colour,
            fixed_function;
    };

    void saveToggles();
    void saveBlend();
    void saveViewport(GLsizei width, GLsizei height);
    void restoreBlend() const;
    void restoreViewport() const;

    Features has_;
    std::vector<Toggle> toggles_;
    std::array<GLint, 4> blend_functions_{};
    std::array<GLint, 2> blend_equations_{};
    std::array<GLboolean, 4> colour_mask_{};
    std::array<GLfloat, 4> viewport_{};
    std::array<GLdouble, 2> depth_range_{};
    std::array<GLint, 2> polygon_mode_{};
    GLint program_ = 0, depth_function_ = 0, clip_origin_ = 0, clip_depth_ = 0, clamp_ = 0;
    GLboolean depth_mask_ = GL_FALSE;
    bool blending_ = false, scissor_ = false, feedback_paused_ = false;
};

/// Active unit, and texture and sampler bindings of units 0 and 1; leaves unit 0 active, both units without sampler.
class UnitGuard {
  public:
    UnitGuard();
    ~UnitGuard();
    UnitGuard(const UnitGuard&) = delete;
    UnitGuard& operator=(const UnitGuard&) = delete;

  private:
    static constexpr std::size_t kUnits = 2;
    bool has_samplers_;
    GLint active_ = 0;
    std::array<GLint, kUnits> textures_{}, samplers_{};
};

}  // namespace sluice::host
