// SPDX-License-Identifier: MIT
#include "glx_caller.hpp"

#include <epoxy/glx.h>

#include <array>

namespace sluice::test {

struct GlxCaller::Impl {
    Display* display = nullptr;
    ::Window window = 0;
    Colormap colours = 0;
    GLXContext context = nullptr;
};

GlxCaller::GlxCaller(const XServer& server, const Version& version, const Window& window)
    : impl_(std::make_unique<Impl>()) {
    Impl& x = *impl_;
    x.display = XOpenDisplay(server.display().c_str());
    if (x.display == nullptr) {
        return;
    }
    const std::array<int, 17> wanted{GLX_RENDER_TYPE,
                                     GLX_RGBA_BIT,
                                     GLX_DOUBLEBUFFER,
                                     True,
                                     GLX_RED_SIZE,
                                     8,
                                     GLX_ALPHA_SIZE,
                                     8,
                                     GLX_DEPTH_SIZE,
                                     24,
                                     GLX_SAMPLES,
                                     window.samples,
                                     GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB,
                                     window.srgb ? True : static_cast<int>(GLX_DONT_CARE),
                                     GLX_DRAWABLE_TYPE,
                                     GLX_WINDOW_BIT,
                                     None};
    int count = 0;
    GLXFBConfig* configs = glXChooseFBConfig(x.display, DefaultScreen(x.display), wanted.data(), &count);
    if (configs == nullptr || count == 0) {
        return;
    }
    GLXFBConfig config = configs[0];
    XFree(configs);
    XVisualInfo* visual = glXGetVisualFromFBConfig(x.display, config);
    XSetWindowAttributes attributes{};
    x.colours = XCreateColormap(x.display, DefaultRootWindow(x.display), visual->visual, AllocNone);
    attributes.colormap = x.colours;
    x.window = XCreateWindow(x.display, DefaultRootWindow(x.display), 0, 0, static_cast<unsigned>(window.width),
                             static_cast<unsigned>(window.height), 0, visual->depth, InputOutput, visual->visual,
                             CWColormap, &attributes);
    XMapWindow(x.display, x.window);
    if (version.major == 1) {
        x.context = glXCreateContext(x.display, visual, nullptr, True);
    } else {
        const std::array<int, 7> asked{
            GLX_CONTEXT_MAJOR_VERSION_ARB,
            version.major,
            GLX_CONTEXT_MINOR_VERSION_ARB,
            version.minor,
            GLX_CONTEXT_PROFILE_MASK_ARB,
            version.core ? GLX_CONTEXT_CORE_PROFILE_BIT_ARB : GLX_CONTEXT_COMPATIBILITY_PROFILE_BIT_ARB,
            None};
        x.context = glXCreateContextAttribsARB(x.display, config, nullptr, True, asked.data());
    }
    XFree(visual);
    if (ok()) {
        glXMakeCurrent(x.display, x.window, x.context);
    }
}

bool GlxCaller::ok() const {
    return impl_->context != nullptr;
}

void GlxCaller::resize(int width, int height) {
    XResizeWindow(impl_->display, impl_->window, static_cast<unsigned>(width), static_cast<unsigned>(height));
    XSync(impl_->display, False);
}

void GlxCaller::swap() const {
    glXSwapBuffers(impl_->display, impl_->window);
}

GlxCaller::~GlxCaller() {
    Impl& x = *impl_;
    if (x.display == nullptr) {
        return;
    }
    glXMakeCurrent(x.display, None, nullptr);
    if (ok()) {
        glXDestroyContext(x.display, x.context);
    }
    if (x.window != 0) {
        XDestroyWindow(x.display, x.window);
        XFreeColormap(x.display, x.colours);
    }
    XCloseDisplay(x.display);
}

}  // namespace sluice::test
