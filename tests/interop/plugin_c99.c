/* SPDX-License-Identifier: MIT
 * plugin.h as a C99 plugin author meets it: what C makes of each struct, for comparison with C++. */
#include <stddef.h>

#include "sluice/plugin.h"

uint32_t sluice_c99_abi_version(void);
size_t sluice_c99_renderer_api_size(void);
size_t sluice_c99_frame_size(void);
size_t sluice_c99_create_info_size(void);
uint32_t sluice_c99_depth_role_bit(void);
SluiceResult sluice_c99_fill_error(SluiceError* error);

uint32_t sluice_c99_abi_version(void) {
    return SLUICE_ABI_VERSION;
}
size_t sluice_c99_renderer_api_size(void) {
    return sizeof(SluiceRendererApi);
}
size_t sluice_c99_frame_size(void) {
    return sizeof(SluiceFrame);
}
size_t sluice_c99_create_info_size(void) {
    return sizeof(SluiceCreateInfo);
}
uint32_t sluice_c99_depth_role_bit(void) {
    return SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_DEPTH);
}

SluiceResult sluice_c99_fill_error(SluiceError* error) {
    error->struct_size = (uint32_t)sizeof *error;
    error->code = SLUICE_ERROR_UNSUPPORTED;
    error->message[0] = 'C';
    error->message[1] = '\0';
    return SLUICE_ERROR_UNSUPPORTED;
}
