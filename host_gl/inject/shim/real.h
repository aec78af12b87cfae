/* SPDX-License-Identifier: MIT
 * The functions that the shim stands in front of. */
#ifndef SLUICE_INJECT_REAL_H
#define SLUICE_INJECT_REAL_H

#include "../payload_abi.h"

typedef void* (*RealDlsym)(void* handle, const char* name);
typedef void* (*RealDlvsym)(void* handle, const char* name, const char* version);

/* The C library's own, read from its symbol table: the names themselves lead back here. NULL if it has none. */
RealDlsym real_dlsym(void);
RealDlvsym real_dlvsym(void);

/* A function of GL, GLX, EGL or SDL past all hooks; never loads a library. */
SluiceInjectFunction real_function(const char* name);

/* The real function of a hook, found once. */
SluiceInjectFunction real_of(SluiceInjectHook* hook);

/* ISO C does not convert between pointers to objects and to functions; POSIX promises that they are alike. */
SluiceInjectFunction as_function(void* address);
void* as_address(SluiceInjectFunction function);

/* Whether `address` lies in this library. */
int is_ours(const void* address);

#endif
