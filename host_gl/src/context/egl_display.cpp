// SPDX-License-Identifier: MIT
#include "context/egl_display.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>
#include <vector>

#include "context/device_choice.hpp"
#include "context/egl_devices.hpp"

namespace sluice::host {
namespace {

constexpr std::string_view kMesaRemedy =
    "install libegl-mesa0 and libgl1-mesa-dri, or the EGL library of your GPU driver";

// The count has to be process-wide because the EGLDisplay is.
struct DisplayUse {
    EGLDisplay display;
    int users;
};
std::mutex display_mutex;
std::vector<DisplayUse> display_uses;

void addUser(EGLDisplay display) {
    for (DisplayUse& use : display_uses) {
        if (use.display == display) {
            ++use.users;
            return;
        }
    }
    display_uses.push_back({display, 1});
}

void removeUser(EGLDisplay display) {
    const std::lock_guard lock(display_mutex);
    const auto use = std::find_if(display_uses.begin(), display_uses.end(),
                                  [display](const DisplayUse& candidate) { return candidate.display == display; });
    if (use != display_uses.end() && --use->users == 0) {
        display_uses.erase(use);
        eglTerminate(display);
    }
}

Error eglError(std::string_view step, std::string_view remedy) {
    return {SLUICE_ERROR_UNSUPPORTED, std::string(step), takeEglError(), std::string(remedy)};
}

}  // namespace

std::string takeEglError() {
    static constexpr std::array<std::pair<EGLint, std::string_view>, 15> kNames{{
        {EGL_SUCCESS, "EGL_SUCCESS"},
        {EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
        {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
        {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
        {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
        {EGL_BAD_CONTEXT, "EGL_BAD_CONTEXT"},
        {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
        {EGL_BAD_CURRENT_SURFACE, "EGL_BAD_CURRENT_SURFACE"},
        {EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
        {EGL_BAD_SURFACE, "EGL_BAD_SURFACE"},
        {EGL_BAD_MATCH, "EGL_BAD_MATCH"},
        {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"},
        {EGL_BAD_NATIVE_PIXMAP, "EGL_BAD_NATIVE_PIXMAP"},
        {EGL_BAD_NATIVE_WINDOW, "EGL_BAD_NATIVE_WINDOW"},
        {EGL_CONTEXT_LOST, "EGL_CONTEXT_LOST"},
    }};
    const EGLint code = eglGetError();
    for (const auto& [value, name] : kNames) {
        if (value == code) {
            return fmt::format("{} (0x{:04x})", name, code);
        }
    }
    return fmt::format("EGL error 0x{:04x}", code);
}

Result<std::shared_ptr<EglDisplay>> EglDisplay::initialise(EGLDisplay display, std::string_view platform) {
    const std::string where = fmt::format(" on the {} platform", platform);
    if (display == EGL_NO_DISPLAY) {
        return eglError("eglGetPlatformDisplay" + where, kMesaRemedy);
    }
    {
        // Held over eglInitialize so that another thread's last eglTerminate cannot fall between it and the count.
        const std::lock_guard lock(display_mutex);
        if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
            return eglError("eglInitialize" + where, kMesaRemedy);
        }
        addUser(display);
    }
    // From here on the destructor gives the display back.
    std::shared_ptr<EglDisplay> opened(new EglDisplay(display, EGL_NO_CONFIG_KHR));
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!inEglList(extensions, "EGL_KHR_surfaceless_context")) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "EGL display" + where, "EGL_KHR_surfaceless_context is missing",
                     std::string(kMesaRemedy)};
    }
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
        return eglError("eglBindAPI(EGL_OPENGL_API)" + where, kMesaRemedy);
    }
    if (!inEglList(extensions, "EGL_KHR_no_config_context") && !inEglList(extensions, "EGL_MESA_configless_context")) {
        const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                                           EGL_NONE};
        EGLint found = 0;
        if (eglChooseConfig(display, wanted.data(), &opened->config_, 1, &found) != EGL_TRUE || found == 0) {
            return eglError("eglChooseConfig(EGL_OPENGL_BIT)" + where, kMesaRemedy);
        }
    }
    return opened;
}

Result<std::shared_ptr<EglDisplay>> EglDisplay::openDevice(std::size_t index) {
    const std::vector<EGLDeviceEXT> devices = listEglDevices();
    if (index >= devices.size()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, kGlDeviceVariable,
                     fmt::format("there is no EGL device {}; EGL lists {}", index, devices.size()),
                     "see the list of EGL devices in 'sluice probe', or unset the variable"};
    }
    return initialise(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[index], nullptr),
                      fmt::format("device {}", index));
}

Result<std::shared_ptr<EglDisplay>> EglDisplay::open() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!inEglList(client, "EGL_EXT_platform_base")) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "EGL client library", "EGL_EXT_platform_base is missing",
                     std::string(kMesaRemedy)};
    }
    const Result<GlDeviceChoice> choice = glDeviceFromEnvironment();
    if (!choice) {
        return choice.error();
    }
    if (choice.value()) {
        auto chosen = openDevice(*choice.value());
        if (!chosen && chosen.error().thing != kGlDeviceVariable) {
            Error error = chosen.error();
            error.thing = fmt::format("{}={}: {}", kGlDeviceVariable, *choice.value(), error.thing);
            return error;
        }
        return chosen;
    }
    std::string tried;
    if (inEglList(client, "EGL_MESA_platform_surfaceless")) {
        auto opened = initialise(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                                 "surfaceless");
        if (opened.ok()) {
            return opened;
        }
        tried = opened.error().message();
    } else {
        tried = "EGL_MESA_platform_surfaceless is missing";
    }
    const std::size_t count = listEglDevices().size();
    for (std::size_t i = 0; i < count; ++i) {
        auto opened = openDevice(i);
        if (opened.ok()) {
            return opened;
        }
        tried += "; " + opened.error().message();
    }
    if (count == 0) {
        tried += "; EGL lists no devices";
    }
    return Error{SLUICE_ERROR_UNSUPPORTED, "EGL display without a window", tried, std::string(kMesaRemedy)};
}

EglDisplay::~EglDisplay() {
    removeUser(display_);
}

}  // namespace sluice::host
