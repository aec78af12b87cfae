/* SPDX-License-Identifier: MIT
 * A renderer that is never there: it hangs while it is loaded, as a driver may. */
#include <unistd.h>

__attribute__((constructor)) static void hang(void) {
    for (;;) {
        (void)pause();
    }
}
