/* SPDX-License-Identifier: MIT
 * The header as an engine in C99 has it, and the library as one that loads it by hand. */
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#include "sluice/sluice.h"

int c99_uses_the_library(void);
int c99_loads_the_library(const char* path, char* why, size_t size);

int c99_uses_the_library(void) {
    SluiceOptions options;
    SluiceWater water;
    Sluice* fluid = NULL;
    sluice_options_defaults(&options, sizeof options);
    sluice_water_defaults(&water, sizeof water);
    if (options.struct_size != sizeof options || water.struct_size != sizeof water) {
        return 1;
    }
    options.struct_size = 4; /* shorter than any version's */
    if (sluice_create(&options, &fluid) != SLUICE_ERROR_INVALID_ARGUMENT || fluid != NULL) {
        return 2;
    }
    /* An engine that never looks at results goes on with NULL. */
    if (sluice_begin_frame(NULL, NULL, NULL, 0.0) != SLUICE_ERROR_INVALID_ARGUMENT ||
        sluice_end_frame(NULL) != SLUICE_ERROR_INVALID_ARGUMENT) {
        return 3;
    }
    sluice_destroy(NULL);
    return strlen(sluice_last_error(NULL)) > 0 ? 0 : 4;
}

typedef union Entry {
    void* object;
    uint32_t (*version)(void);
} Entry;

int c99_loads_the_library(const char* path, char* why, size_t size) {
    void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    Entry entry;
    uint32_t version = 0;
    if (library == NULL) {
        (void)snprintf(why, size, "%s", dlerror());
        return 1;
    }
    entry.object = dlsym(library, "sluice_api_version");
    if (entry.object != NULL) {
        version = entry.version();
    }
    (void)dlclose(library);
    return version >> 16 == SLUICE_API_MAJOR ? 0 : 2;
}
