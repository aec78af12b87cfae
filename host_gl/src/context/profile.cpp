// SPDX-License-Identifier: MIT
#include "context/profile.hpp"

#include <epoxy/gl.h>

namespace sluice::host {

namespace {

thread_local bool gone = false;

}  // namespace

bool hasFixedFunction() {
    const int version = epoxy_gl_version();
    if (version < 31) {
        return true;
    }
    if (version < 32) {
        return epoxy_has_gl_extension("GL_ARB_compatibility");
    }
    GLint profile = 0;
    glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
    // 0: a driver that hands out the one context it has, to a host that asked for no version.
    return (profile & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT) != 0 || profile == 0;
}

GlGone::GlGone() : before_(gone) {
    gone = true;
}

GlGone::~GlGone() {
    gone = before_;
}

bool glGone() {
    return gone;
}

}  // namespace sluice::host
