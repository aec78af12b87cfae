// SPDX-License-Identifier: MIT
#include "compositor/draw_guard.hpp"

#include <fmt/format.h>

#include "context/profile.hpp"

namespace sluice::host {

namespace {

bool has(int version, const char* extension) {
    return epoxy_gl_version() >= version || epoxy_has_gl_extension(extension);
}

/// Toggles that could drop, move or change a fragment of the quad.
std::vector<GLenum> togglesOfThisContext(bool fixed_function) {
    std::vector<GLenum> names{GL_COLOR_LOGIC_OP,
                              GL_CULL_FACE,
                              GL_DEPTH_TEST,
                              GL_DITHER,
                              GL_POLYGON_OFFSET_FILL,
                              GL_POLYGON_SMOOTH,
                              GL_SAMPLE_ALPHA_TO_COVERAGE,
                              GL_STENCIL_TEST,
                              GL_SAMPLE_COVERAGE,
                              GL_SAMPLE_ALPHA_TO_ONE};
    if (fixed_function) {
        names.push_back(GL_ALPHA_TEST);
        names.push_back(GL_POLYGON_STIPPLE);
    }
    if (epoxy_gl_version() >= 30) {
        names.push_back(GL_RASTERIZER_DISCARD);
    }
    if (has(30, "GL_ARB_framebuffer_sRGB")) {
        names.push_back(GL_FRAMEBUFFER_SRGB);
    }
    if (has(32, "GL_ARB_depth_clamp")) {
        names.push_back(GL_DEPTH_CLAMP);
    }
    if (has(32, "GL_ARB_texture_multisample")) {
        names.push_back(GL_SAMPLE_MASK);
    }
    if (epoxy_has_gl_extension("GL_EXT_depth_bounds_test")) {
        names.push_back(GL_DEPTH_BOUNDS_TEST_EXT);
    }
    GLint planes = 0;
    glGetIntegerv(GL_MAX_CLIP_PLANES, &planes);
    for (GLint plane = 0; plane < planes; ++plane) {
        names.push_back(GL_CLIP_PLANE0 + static_cast<GLenum>(plane));
    }
    return names;
}

void set(GLenum name, bool on) {
    if (on) {
        glEnable(name);
    } else {
        glDisable(name);
    }
}

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

GLenum enumeration(GLint value) {
    return static_cast<GLenum>(value);
}

}  // namespace

Status checkDrawable() {
    if (!hasFixedFunction()) {
        return {};
    }
    if (const GLint list = integer(GL_LIST_INDEX); list != 0) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "OpenGL state",
                     fmt::format("display list {} is being compiled", list), "call glEndList before Sluice"};
    }
    if (const GLint mode = integer(GL_RENDER_MODE); mode != GL_RENDER) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "OpenGL state",
                     fmt::format("the render mode is 0x{:04x}, expected GL_RENDER", mode),
                     "call glRenderMode(GL_RENDER) before Sluice"};
    }
    return {};
}

DrawGuard::DrawGuard(GLsizei width, GLsizei height)
    : has_{.indexed_masks = epoxy_gl_version() >= 30,
           .indexed_blend = has(40, "GL_ARB_draw_buffers_blend"),
           .viewport_arrays = has(41, "GL_ARB_viewport_array"),
           .feedback_objects = has(40, "GL_ARB_transform_feedback2"),
           .clip_control = has(45, "GL_ARB_clip_control"),
           .clamp_colour = false,
           .fixed_function = hasFixedFunction()} {
    // Core profiles clamp what is read and nothing else.
    has_.clamp_colour = has_.fixed_function && has(30, "GL_ARB_color_buffer_float");
    // First of all: no program may be changed while transform feedback runs.
    if (has_.feedback_objects && integer(GL_TRANSFORM_FEEDBACK_ACTIVE) != 0 &&
        integer(GL_TRANSFORM_FEEDBACK_PAUSED) == 0) {
        glPauseTransformFeedback();
        feedback_paused_ = true;
    }
    program_ = integer(GL_CURRENT_PROGRAM);
    saveToggles();
    saveBlend();
    saveViewport(width, height);
    glGetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
    if (!has_.fixed_function) {
        polygon_mode_[1] = polygon_mode_[0];  // one mode for both faces; a driver may return one number or two
    }
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    depth_function_ = integer(GL_DEPTH_FUNC);
    glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
    if (has_.clamp_colour) {
        clamp_ = integer(GL_CLAMP_FRAGMENT_COLOR);
        glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FIXED_ONLY);
    }
}

void DrawGuard::saveToggles() {
    for (const GLenum name : togglesOfThisContext(has_.fixed_function)) {
        toggles_.push_back({name, glIsEnabled(name) == GL_TRUE});
        glDisable(name);
    }
}

void DrawGuard::saveBlend() {
    if (has_.indexed_masks) {
        blending_ = glIsEnabledi(GL_BLEND, 0) == GL_TRUE;
        glDisablei(GL_BLEND, 0);
        glGetBooleani_v(GL_COLOR_WRITEMASK, 0, colour_mask_.data());
        glColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    } else {
        blending_ = glIsEnabled(GL_BLEND) == GL_TRUE;
        glDisable(GL_BLEND);
        glGetBooleanv(GL_COLOR_WRITEMASK, colour_mask_.data());
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    const std::array<GLenum, 4> functions{GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA};
    const std::array<GLenum, 2> equations{GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA};
    for (std::size_t i = 0; i < functions.size(); ++i) {
        if (has_.indexed_blend) {
            glGetIntegeri_v(functions[i], 0, &blend_functions_[i]);
        } else {
            blend_functions_[i] = integer(functions[i]);
        }
    }
    for (std::size_t i = 0; i < equations.size(); ++i) {
        if (has_.indexed_blend) {
            glGetIntegeri_v(equations[i], 0, &blend_equations_[i]);
        } else {
            blend_equations_[i] = integer(equations[i]);
        }
    }
}

void DrawGuard::saveViewport(GLsizei width, GLsizei height) {
    if (has_.viewport_arrays) {
        glGetFloati_v(GL_VIEWPORT, 0, viewport_.data());
        glViewportIndexedf(0, 0.0F, 0.0F, static_cast<GLfloat>(width), static_cast<GLfloat>(height));
        glGetDoublei_v(GL_DEPTH_RANGE, 0, depth_range_.data());
        glDepthRangeIndexed(0, 0.0, 1.0);
        scissor_ = glIsEnabledi(GL_SCISSOR_TEST, 0) == GL_TRUE;
        glDisablei(GL_SCISSOR_TEST, 0);
    } else {
        glGetFloatv(GL_VIEWPORT, viewport_.data());
        glViewport(0, 0, width, height);
        glGetDoublev(GL_DEPTH_RANGE, depth_range_.data());
        glDepthRange(0.0, 1.0);
        scissor_ = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
        glDisable(GL_SCISSOR_TEST);
    }
    if (has_.clip_control) {
        clip_origin_ = integer(GL_CLIP_ORIGIN);
        clip_depth_ = integer(GL_CLIP_DEPTH_MODE);
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    }
}

void DrawGuard::restoreBlend() const {
    if (has_.indexed_masks) {
        if (blending_) {
            glEnablei(GL_BLEND, 0);
        } else {
            glDisablei(GL_BLEND, 0);
        }
        glColorMaski(0, colour_mask_[0], colour_mask_[1], colour_mask_[2], colour_mask_[3]);
    } else {
        set(GL_BLEND, blending_);
        glColorMask(colour_mask_[0], colour_mask_[1], colour_mask_[2], colour_mask_[3]);
    }
    if (has_.indexed_blend) {
        glBlendFuncSeparatei(0, enumeration(blend_functions_[0]), enumeration(blend_functions_[1]),
                             enumeration(blend_functions_[2]), enumeration(blend_functions_[3]));
        glBlendEquationSeparatei(0, enumeration(blend_equations_[0]), enumeration(blend_equations_[1]));
    } else {
        glBlendFuncSeparate(enumeration(blend_functions_[0]), enumeration(blend_functions_[1]),
                            enumeration(blend_functions_[2]), enumeration(blend_functions_[3]));
        glBlendEquationSeparate(enumeration(blend_equations_[0]), enumeration(blend_equations_[1]));
    }
}

void DrawGuard::restoreViewport() const {
    if (has_.clip_control) {
        glClipControl(enumeration(clip_origin_), enumeration(clip_depth_));
    }
    if (has_.viewport_arrays) {
        glViewportIndexedfv(0, viewport_.data());
        glDepthRangeIndexed(0, depth_range_[0], depth_range_[1]);
        if (scissor_) {
            glEnablei(GL_SCISSOR_TEST, 0);
        }
    } else {
        glViewport(static_cast<GLint>(viewport_[0]), static_cast<GLint>(viewport_[1]),
                   static_cast<GLsizei>(viewport_[2]), static_cast<GLsizei>(viewport_[3]));
        glDepthRange(depth_range_[0], depth_range_[1]);
        set(GL_SCISSOR_TEST, scissor_);
    }
}

DrawGuard::~DrawGuard() {
    if (has_.clamp_colour) {
        glClampColor(GL_CLAMP_FRAGMENT_COLOR, enumeration(clamp_));
    }
    glDepthMask(depth_mask_);
    glDepthFunc(enumeration(depth_function_));
    if (polygon_mode_[0] == polygon_mode_[1]) {
        glPolygonMode(GL_FRONT_AND_BACK, enumeration(polygon_mode_[0]));
    } else {
        glPolygonMode(GL_FRONT, enumeration(polygon_mode_[0]));
        glPolygonMode(GL_BACK, enumeration(polygon_mode_[1]));
    }
    restoreViewport();
    restoreBlend();
    for (const Toggle& toggle : toggles_) {
        set(toggle.name, toggle.was_on);
    }
    glUseProgram(static_cast<GLuint>(program_));
    if (feedback_paused_) {
        glResumeTransformFeedback();
    }
}

UnitGuard::UnitGuard() : has_samplers_(has(33, "GL_ARB_sampler_objects")) {
    active_ = integer(GL_ACTIVE_TEXTURE);
    for (std::size_t unit = kUnits; unit-- > 0;) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        textures_.at(unit) = integer(GL_TEXTURE_BINDING_2D);
        if (has_samplers_) {
            samplers_.at(unit) = integer(GL_SAMPLER_BINDING);
            glBindSampler(static_cast<GLuint>(unit), 0);
        }
    }
}

UnitGuard::~UnitGuard() {
    for (std::size_t unit = 0; unit < kUnits; ++unit) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(textures_.at(unit)));
        if (has_samplers_) {
            glBindSampler(static_cast<GLuint>(unit), static_cast<GLuint>(samplers_.at(unit)));
        }
    }
    glActiveTexture(enumeration(active_));
}

}  // namespace sluice::host
