/* SPDX-License-Identifier: MIT
 * What the launcher said, taken out of the environment before the program sees it. */
#include "shim.h"

#include <stddef.h>
#include <string.h>

#define SETTINGS "SLUICE_INJECT="
#define PRELOAD "LD_PRELOAD="

extern char** environ;

/* A copy: some programs write over the memory of their environment, to change their title. */
static char settings[16384];

const char* shim_settings(void) {
    return settings;
}

static char** find_variable(const char* name_and_equals) {
    for (char** at = environ; at != NULL && *at != NULL; ++at) {
        if (strncmp(*at, name_and_equals, strlen(name_and_equals)) == 0) {
            return at;
        }
    }
    return NULL;
}

static void remove_variable(char** at) {
    for (; *at != NULL; ++at) {
        at[0] = at[1];
    }
}

/* The launcher puts the shim first, so what the user preloads besides stays. */
static void remove_from_preload(const char* shim, size_t length) {
    char** variable = find_variable(PRELOAD);
    if (variable == NULL) {
        return;
    }
    char* value = *variable + strlen(PRELOAD);
    if (strncmp(value, shim, length) != 0) {
        return;
    }
    if (value[length] == '\0') {
        remove_variable(variable);
    } else if (value[length] == ':' || value[length] == ' ') {
        memmove(value, value + length + 1, strlen(value + length + 1) + 1);
    }
}

/* Runs in every process that the shim is loaded into, so it allocates nothing and opens nothing. */
__attribute__((constructor)) static void take_settings(void) {
    char** variable = find_variable(SETTINGS);
    if (variable == NULL) {
        return;
    }
    const char* text = *variable + strlen(SETTINGS);
    if (strlen(text) >= sizeof(settings)) {
        return;
    }
    memcpy(settings, text, strlen(text) + 1);
    if (strncmp(settings, "children\n", 9) == 0) { /* the launcher puts it first */
        return;
    }
    remove_variable(variable);
    const char* shim = strstr(settings, "shim ");
    if (shim != NULL) {
        shim += strlen("shim ");
        remove_from_preload(shim, strcspn(shim, "\n"));
    }
}
