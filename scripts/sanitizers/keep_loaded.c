// SPDX-License-Identifier: MIT
// Preloaded into sanitised tests only: nothing is unloaded, so a report can name the library of every frame.
//
// Seen without it (Debian 12, gcc 12, Mesa 22.3.6, a program that makes and destroys one Vulkan device or one EGL context):
// the loader unloads the driver before LeakSanitizer looks, so what the driver keeps in its own globals (128 bytes a load)
// is reported as leaked from "<unknown module>", which no suppression can name; and ThreadSanitizer stops with "library was
// matched against called_from_lib suppression is unloaded". With it neither program has a report, and no leak
// suppression is needed for them.
int dlclose(void* handle);
int dlclose(void* handle) {
    (void)handle;
    return 0;
}
