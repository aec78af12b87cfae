/* SPDX-License-Identifier: MIT
 * An EGL vendor library (libglvnd) with one device that is no software renderer and draws nothing: a graphics card
 * whose driver is not installed. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <glvnd/libeglabi.h>
#include <stddef.h>
#include <string.h>

static int card; /* its address is the device */

static const char* queryString(EGLDisplay display, EGLint name) {
    return display == EGL_NO_DISPLAY && name == EGL_EXTENSIONS
               ? "EGL_EXT_platform_base EGL_EXT_platform_device EGL_EXT_device_base EGL_EXT_device_enumeration "
                 "EGL_EXT_device_query"
               : NULL;
}

static EGLBoolean queryDevices(EGLint max, EGLDeviceEXT* devices, EGLint* count) {
    if (devices != NULL && max > 0) {
        devices[0] = &card;
    }
    *count = 1;
    return EGL_TRUE;
}

static const char* queryDeviceString(EGLDeviceEXT device, EGLint name) {
    (void)device;
    return name == EGL_EXTENSIONS ? "EGL_SLUICE_card_of_a_test" : NULL;
}

static EGLint getError(void) {
    return EGL_SUCCESS;
}

/* For the entry points that libglvnd insists on and calls with displays of this vendor only, of which there are none.
 */
static EGLBoolean never(void) {
    return EGL_FALSE;
}

typedef void (*Function)(void);

static void* getProcAddress(const char* name) {
    static const struct {
        const char* name;
        Function function;
    } known[] = {{"eglQueryString", (Function)queryString},
                 {"eglQueryDevicesEXT", (Function)queryDevices},
                 {"eglQueryDeviceStringEXT", (Function)queryDeviceString},
                 {"eglGetError", (Function)getError}};
    Function found = (Function)never;
    for (size_t i = 0; i < sizeof(known) / sizeof(known[0]); ++i) {
        if (strcmp(known[i].name, name) == 0) {
            found = known[i].function;
        }
    }
    void* address = NULL;
    memcpy(&address, &found, sizeof(address));
    return address;
}

static EGLDisplay getPlatformDisplay(EGLenum platform, void* native, const EGLAttrib* attributes) {
    (void)platform, (void)native, (void)attributes;
    return EGL_NO_DISPLAY;
}

/* A vendor that supports no API is not loaded. */
static EGLBoolean getSupportsApi(EGLenum api) {
    return api == EGL_OPENGL_API ? EGL_TRUE : EGL_FALSE;
}

static void* getDispatchAddress(const char* name) {
    (void)name;
    return NULL;
}

static void setDispatchIndex(const char* name, int index) {
    (void)name, (void)index;
}

__attribute__((visibility("default"))) EGLBoolean __egl_Main(uint32_t version, const __EGLapiExports* exports,
                                                             __EGLvendorInfo* vendor, __EGLapiImports* imports) {
    (void)exports, (void)vendor;
    if (EGL_VENDOR_ABI_GET_MAJOR_VERSION(version) != EGL_VENDOR_ABI_MAJOR_VERSION) {
        return EGL_FALSE;
    }
    imports->getPlatformDisplay = getPlatformDisplay;
    imports->getSupportsAPI = getSupportsApi;
    imports->getProcAddress = getProcAddress;
    imports->getDispatchAddress = getDispatchAddress;
    imports->setDispatchIndex = setDispatchIndex;
    return EGL_TRUE;
}
