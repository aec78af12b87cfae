/* SPDX-License-Identifier: MIT
 * Preloaded into a program that moves by the time of day: every frame of it is the first one. */
#include <sys/time.h>

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
    (void)zone;
    now->tv_sec = 1000000;
    now->tv_usec = 0;
    return 0;
}
