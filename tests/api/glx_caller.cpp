// SPDX-License-Identifier: MIT
#include "glx_caller.hpp"

#include <epoxy/glx.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace sluice::test {

XServer::XServer() {
    std::array<int, 2> told{};
    if (::pipe(told.data()) != 0) {
        return;
    }
    constexpr int kTold = 9;
    posix_spawn_file_actions_t files{};
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, told[1], kTold);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::array<std::string, 9> words{
        "Xvfb", "-displayfd", std::to_string(kTold), "-screen", "0", "640x480x24", "-nolisten", "tcp", "-noreset"};
    std::array<char*, 10> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) {
        arguments.at(i) = words.at(i).data();
    }
    if (::posix_spawnp(&pid_, "Xvfb", &files, nullptr, arguments.data(), environ) != 0) {
        pid_ = -1;
    }
    posix_spawn_file_actions_destroy(&files);
    ::close(told[1]);
    for (char letter = 0; ::read(told[0], &letter, 1) == 1 && letter != '\n';) {
        name_ += letter;
    }
    ::close(told[0]);
    if (!name_.empty()) {
        name_.insert(0, ":");
    }
}

XServer::~XServer() {
    if (pid_ > 0) {
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
    }
}

struct GlxCaller::Impl {
    Display* display = nullptr;
    ::Window window = 0;
    Colormap colours = 0;
    GLXContext context = nullptr;
};

GlxCaller::GlxCaller(const XServer& server, const Version& version, const Window& window)
    : impl_(std::make_unique<Impl>()) {
    Impl& x = *impl_;
    x.display = XOpenDisplay(server.name().c_str());
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
