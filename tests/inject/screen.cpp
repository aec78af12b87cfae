// SPDX-License-Identifier: MIT
#include "screen.hpp"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace sluice::inject::test {

ScreenView::ScreenView(const std::string& display) : display_(XOpenDisplay(display.c_str())) {}

ScreenView::~ScreenView() {
    if (display_ != nullptr) {
        XCloseDisplay(display_);
    }
}

std::vector<unsigned long> ScreenView::look(int width, int height) const {
    XImage* image = XGetImage(display_, DefaultRootWindow(display_), 0, 0, static_cast<unsigned>(width),
                              static_cast<unsigned>(height), AllPlanes, ZPixmap);
    std::vector<unsigned long> picture;
    for (int i = 0; image != nullptr && i < width * height; ++i) {
        picture.push_back(XGetPixel(image, i % width, i / width) & 0xFFFFFFU);
    }
    if (image != nullptr) {
        XDestroyImage(image);
    }
    return picture;
}

void ScreenView::wipe() const {
    XClearWindow(display_, DefaultRootWindow(display_));
    XSync(display_, False);
}

}  // namespace sluice::inject::test
