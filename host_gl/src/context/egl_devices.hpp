// SPDX-License-Identifier: MIT
// The devices of EGL_EXT_device_enumeration.
#pragma once

#include <epoxy/egl.h>

#include <vector>

namespace sluice::host {

/// In EGL's order, which is that of SLUICE_GL_DEVICE; empty where EGL cannot list or open devices.
[[nodiscard]] std::vector<EGLDeviceEXT> listEglDevices();
/// True for Mesa's llvmpipe and its like.
[[nodiscard]] bool isSoftwareDevice(EGLDeviceEXT device);
/// `extensions`, a list separated by blanks, holds `name`. Null holds nothing.
[[nodiscard]] bool inEglList(const char* extensions, const char* name);

}  // namespace sluice::host
