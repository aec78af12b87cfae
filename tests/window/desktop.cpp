// SPDX-License-Identifier: MIT
#include "desktop.hpp"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>

#include <thread>

namespace window::test {
namespace {

/// Between two acts of a hand, so that each gets a frame of its own.
constexpr auto kPause = std::chrono::milliseconds(60);

/// The window of that title below `from`, or 0.
::Window find(Display* display, ::Window from, const std::string& title) {
    char* name = nullptr;
    if (XFetchName(display, from, &name) != 0) {
        const bool same = title == name;
        XFree(name);
        if (same) {
            return from;
        }
    }
    ::Window root = 0;
    ::Window parent = 0;
    ::Window* children = nullptr;
    unsigned count = 0;
    if (XQueryTree(display, from, &root, &parent, &children, &count) == 0) {
        return 0;
    }
    ::Window found = 0;
    for (unsigned i = 0; i < count && found == 0; ++i) {
        found = find(display, children[i], title);
    }
    if (children != nullptr) {
        XFree(children);
    }
    return found;
}

/// A window may end while it is being asked about: that is no reason for Xlib to end the test.
int ignoreErrors(Display* /*display*/, XErrorEvent* /*error*/) {
    return 0;
}

}  // namespace

bool until(const std::function<bool()>& condition, std::chrono::seconds longest) {
    const auto end = std::chrono::steady_clock::now() + longest;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

Hand::Hand(const std::string& display, const std::string& title) {
    XSetErrorHandler(ignoreErrors);
    display_ = XOpenDisplay(display.c_str());
    if (display_ == nullptr) {
        return;
    }
    XWindowAttributes seen{};
    const bool there = until([&] {
        window_ = find(display_, DefaultRootWindow(display_), title);
        return window_ != 0 && XGetWindowAttributes(display_, window_, &seen) != 0 && seen.map_state == IsViewable;
    });
    if (!there) {
        window_ = 0;
        return;
    }
    // Without a window manager nobody else does that.
    XSetInputFocus(display_, window_, RevertToParent, CurrentTime);
    flush();
}

Hand::~Hand() {
    if (display_ != nullptr) {
        XCloseDisplay(display_);
    }
}

void Hand::flush() {
    XSync(display_, False);
    std::this_thread::sleep_for(kPause);
}

void Hand::move(int x, int y) {
    int at_x = 0;
    int at_y = 0;
    ::Window child = 0;
    XTranslateCoordinates(display_, window_, DefaultRootWindow(display_), x, y, &at_x, &at_y, &child);
    XTestFakeMotionEvent(display_, -1, at_x, at_y, CurrentTime);
    flush();
}

void Hand::button(unsigned number, bool down) {
    XTestFakeButtonEvent(display_, number, down ? True : False, CurrentTime);
    flush();
}

void Hand::click(unsigned number) {
    button(number, true);
    button(number, false);
}

void Hand::key(unsigned long symbol) {
    const KeyCode code = XKeysymToKeycode(display_, symbol);
    XTestFakeKeyEvent(display_, code, True, CurrentTime);
    flush();
    XTestFakeKeyEvent(display_, code, False, CurrentTime);
    flush();
}

void Hand::resize(unsigned width, unsigned height) {
    XResizeWindow(display_, window_, width, height);
    flush();
}

void Hand::show(bool shown) {
    shown ? XMapWindow(display_, window_) : XUnmapWindow(display_, window_);
    flush();
    if (shown) {
        XSetInputFocus(display_, window_, RevertToParent, CurrentTime);
        flush();
    }
}

void Hand::close() {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window_;
    event.xclient.message_type = XInternAtom(display_, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display_, "WM_DELETE_WINDOW", False));
    XSendEvent(display_, window_, False, NoEventMask, &event);
    flush();
}

Rgb Hand::look() {
    XWindowAttributes seen{};
    XGetWindowAttributes(display_, window_, &seen);
    Rgb out{seen.width, seen.height, {}};
    XImage* image = XGetImage(display_, window_, 0, 0, static_cast<unsigned>(seen.width),
                              static_cast<unsigned>(seen.height), AllPlanes, ZPixmap);
    if (image == nullptr) {
        return {};
    }
    for (int y = 0; y < seen.height; ++y) {
        for (int x = 0; x < seen.width; ++x) {
            const unsigned long pixel = XGetPixel(image, x, y);
            for (const unsigned shift : {16U, 8U, 0U}) {
                out.values.push_back(static_cast<std::uint8_t>(pixel >> shift & 0xffU));
            }
        }
    }
    XDestroyImage(image);
    return out;
}

}  // namespace window::test
