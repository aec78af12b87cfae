// SPDX-License-Identifier: MIT
#include <epoxy/gl.h>

#include "sluice/host_gl/context.hpp"

namespace sluice::host {

std::string_view contextLoss() {
    GLenum status = GL_NO_ERROR;
    // The function exists under a name of its own in each of these; GL 4.5 has it as the second.
    if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness")) {
        status = glGetGraphicsResetStatus();
    } else if (epoxy_has_gl_extension("GL_ARB_robustness")) {
        status = glGetGraphicsResetStatusARB();
    }
    switch (status) {
        case GL_NO_ERROR:
            return {};
        case GL_GUILTY_CONTEXT_RESET:
            return "this context has caused a reset of the GPU";
        case GL_INNOCENT_CONTEXT_RESET:
            return "another context has caused a reset of the GPU";
        default:
            return "the GPU has been reset";
    }
}

}  // namespace sluice::host
