// SPDX-License-Identifier: MIT
#include "context/egl_devices.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <string>

#include "context/device_choice.hpp"
#include "sluice/host_gl/context.hpp"

namespace sluice::host {

namespace {

// EGL registry, EGL_EXT_device_query_name; libepoxy 1.5.10 does not know it yet.
constexpr EGLint kRendererName = 0x335F;  // EGL_RENDERER_EXT

const char* textOf(EGLDeviceEXT device, EGLint name) {
    const char* text = eglQueryDeviceStringEXT(device, name);
    if (text == nullptr) {
        eglGetError();  // an attribute that this device lacks is no error of anybody's
    }
    return text;
}

std::string describe(std::size_t index, EGLDeviceEXT device) {
    const char* extensions = textOf(device, EGL_EXTENSIONS);
    std::string line = fmt::format("{}: ", index);
    // EGL_VENDOR and EGL_RENDERER_EXT of a device need EGL_EXT_device_query_name.
    if (inEglList(extensions, "EGL_EXT_device_query_name")) {
        for (const EGLint name : {EGLint{EGL_VENDOR}, kRendererName}) {
            const char* text = textOf(device, name);
            line += text != nullptr ? fmt::format("{} ", text) : std::string{};
        }
    }
    if (inEglList(extensions, "EGL_EXT_device_drm")) {
        const char* file = textOf(device, EGL_DRM_DEVICE_FILE_EXT);
        line += file != nullptr ? fmt::format("{} ", file) : std::string{};
    }
    return line + fmt::format("[{}]", extensions != nullptr ? extensions : "");
}

}  // namespace

bool inEglList(const char* extensions, const char* name) {
    return extensions != nullptr && epoxy_extension_in_string(extensions, name);
}

std::vector<EGLDeviceEXT> listEglDevices() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool can_list = inEglList(client, "EGL_EXT_device_enumeration") || inEglList(client, "EGL_EXT_device_base");
    std::array<EGLDeviceEXT, 16> list{};
    EGLint count = 0;
    if (!can_list || !inEglList(client, "EGL_EXT_platform_device") ||
        eglQueryDevicesEXT(static_cast<EGLint>(list.size()), list.data(), &count) != EGL_TRUE) {
        return {};
    }
    // Not in braces: a pointer converts to EGLDeviceEXT, which is void*, and the vector would hold the two ends.
    std::vector<EGLDeviceEXT> devices(list.begin(), list.begin() + count);
    return devices;
}

bool isSoftwareDevice(EGLDeviceEXT device) {
    return inEglList(textOf(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

std::vector<std::string> eglDevices() {
    std::vector<std::string> lines;
    for (EGLDeviceEXT device : listEglDevices()) {
        lines.push_back(describe(lines.size(), device));
    }
    return lines;
}

std::string glDeviceNote() {
    const GLubyte* name = glGetString(GL_RENDERER);
    std::vector<bool> software;
    for (EGLDeviceEXT device : listEglDevices()) {
        software.push_back(isSoftwareDevice(device));
    }
    return deviceNote(name != nullptr ? reinterpret_cast<const char*>(name) : "", glDeviceVariable(), software);
}

}  // namespace sluice::host
