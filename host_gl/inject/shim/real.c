/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE
#include "real.h"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <stddef.h>
#include <string.h>

/* Where a loaded library's symbols are. */
typedef struct Symbols {
    ElfW(Addr) base;
    const ElfW(Sym) * table;
    const char* names;
    const uint32_t* gnu_hash;
    const uint32_t* sysv_hash;
} Symbols;

/* The loader relocates these pointers in place on most machines, not on all. */
static ElfW(Addr) absolute(ElfW(Addr) base, ElfW(Addr) pointer) {
    return pointer < base ? base + pointer : pointer;
}

static Symbols symbols_of(const struct dl_phdr_info* library) {
    Symbols found = {library->dlpi_addr, NULL, NULL, NULL, NULL};
    for (int i = 0; i < library->dlpi_phnum; ++i) {
        if (library->dlpi_phdr[i].p_type != PT_DYNAMIC) {
            continue;
        }
        const ElfW(Dyn)* entry = (const ElfW(Dyn)*)(library->dlpi_addr + library->dlpi_phdr[i].p_vaddr);
        for (; entry->d_tag != DT_NULL; ++entry) {
            const ElfW(Addr) at = absolute(found.base, entry->d_un.d_ptr);
            switch (entry->d_tag) {
                case DT_SYMTAB:
                    found.table = (const ElfW(Sym)*)at;
                    break;
                case DT_STRTAB:
                    found.names = (const char*)at;
                    break;
                case DT_GNU_HASH:
                    found.gnu_hash = (const uint32_t*)at;
                    break;
                case DT_HASH:
                    found.sysv_hash = (const uint32_t*)at;
                    break;
                default:
                    break;
            }
        }
    }
    return found;
}

static void* address_if(const Symbols* in, uint32_t index, const char* name) {
    const ElfW(Sym)* symbol = &in->table[index];
    const int is_function = ELF64_ST_TYPE(symbol->st_info) == STT_FUNC;
    if (symbol->st_shndx == SHN_UNDEF || !is_function || strcmp(in->names + symbol->st_name, name) != 0) {
        return NULL;
    }
    return (void*)(in->base + symbol->st_value);
}

static void* look_up_gnu(const Symbols* in, const char* name) {
    uint32_t hash = 5381;
    for (const char* c = name; *c != '\0'; ++c) {
        hash = hash * 33 + (uint8_t)*c;
    }
    const uint32_t buckets = in->gnu_hash[0], first = in->gnu_hash[1], bloom_words = in->gnu_hash[2];
    const uint32_t* bucket = in->gnu_hash + 4 + bloom_words * (sizeof(ElfW(Addr)) / sizeof(uint32_t));
    const uint32_t* chain = bucket + buckets;
    uint32_t index = buckets == 0 ? 0 : bucket[hash % buckets];
    if (index < first) {
        return NULL;
    }
    for (;; ++index) {
        const uint32_t entry = chain[index - first];
        void* found = (entry | 1U) == (hash | 1U) ? address_if(in, index, name) : NULL;
        if (found != NULL || (entry & 1U) != 0) {
            return found;
        }
    }
}

static void* look_up_sysv(const Symbols* in, const char* name) {
    const uint32_t count = in->sysv_hash[1];
    for (uint32_t index = 1; index < count; ++index) {
        void* found = address_if(in, index, name);
        if (found != NULL) {
            return found;
        }
    }
    return NULL;
}

typedef struct Search {
    const char* name;
    void* found;
} Search;

/* In the C library, and in libdl, which had these functions before glibc 2.34. */
static int look_in(struct dl_phdr_info* library, size_t size, void* data) {
    (void)size;
    Search* search = data;
    const char* path = library->dlpi_name == NULL ? "" : library->dlpi_name;
    const char* slash = strrchr(path, '/');
    const char* file = slash == NULL ? path : slash + 1;
    if (strncmp(file, "libc.so", 7) != 0 && strncmp(file, "libc-", 5) != 0 && strncmp(file, "libdl", 5) != 0) {
        return 0;
    }
    const Symbols symbols = symbols_of(library);
    if (symbols.table == NULL || symbols.names == NULL) {
        return 0;
    }
    if (symbols.gnu_hash != NULL) {
        search->found = look_up_gnu(&symbols, search->name);
    } else if (symbols.sysv_hash != NULL) {
        search->found = look_up_sysv(&symbols, search->name);
    }
    return search->found != NULL;
}

static void* in_c_library(void** kept, const char* name) {
    void* found = __atomic_load_n(kept, __ATOMIC_ACQUIRE);
    if (found == NULL) {
        Search search = {name, NULL};
        dl_iterate_phdr(look_in, &search);
        found = search.found;
        __atomic_store_n(kept, found, __ATOMIC_RELEASE);
    }
    return found;
}

SluiceInjectFunction as_function(void* address) {
    SluiceInjectFunction function = NULL;
    memcpy(&function, &address, sizeof(function));
    return function;
}

void* as_address(SluiceInjectFunction function) {
    void* address = NULL;
    memcpy(&address, &function, sizeof(address));
    return address;
}

RealDlsym real_dlsym(void) {
    static void* kept;
    return (RealDlsym)as_function(in_c_library(&kept, "dlsym"));
}

RealDlvsym real_dlvsym(void) {
    static void* kept;
    return (RealDlvsym)as_function(in_c_library(&kept, "dlvsym"));
}

int is_ours(const void* address) {
    static const char own = 0;
    Dl_info there, here;
    return address != NULL && dladdr(address, &there) != 0 && dladdr(&own, &here) != 0 &&
           there.dli_fbase == here.dli_fbase;
}

static void* in_libraries(const char* name) {
    const RealDlsym find = real_dlsym();
    if (find == NULL) {
        return NULL;
    }
    void* found = find(RTLD_NEXT, name);
    /* A program may have opened the library itself, with the symbols to itself. */
    static const char* const libraries[] = {"libGL.so.1",       "libGLX.so.0",     "libEGL.so.1",
                                            "libOpenGL.so.0",   "libGLESv2.so.2",  "libGLESv1_CM.so.1",
                                            "libSDL2-2.0.so.0", "libSDL-1.2.so.0", "libglut.so.3"};
    for (size_t i = 0; found == NULL && i < sizeof(libraries) / sizeof(libraries[0]); ++i) {
        void* library = dlopen(libraries[i], RTLD_LAZY | RTLD_NOLOAD);
        if (library != NULL) {
            found = find(library, name);
            (void)dlclose(library); /* NOLOAD counted a reference; the program's own keeps it */
        }
    }
    return is_ours(found) ? NULL : found;
}

/* Functions that no library exports are known to GetProcAddress alone. EGL's makes up an address for whatever begins
 * with "gl", so it is not asked for GLX: a program without GLX would seem to have it. */
static void* by_get_proc_address(const char* name) {
    static const char* const ways[] = {"glXGetProcAddressARB", "eglGetProcAddress"};
    const size_t count = strncmp(name, "glX", 3) == 0 ? 1 : 2;
    for (size_t i = 0; i < count; ++i) {
        void* (*const get)(const char*) = (void* (*)(const char*))as_function(in_libraries(ways[i]));
        void* found = get == NULL ? NULL : get(name);
        if (found != NULL && !is_ours(found)) {
            return found;
        }
    }
    return NULL;
}

SluiceInjectFunction real_function(const char* name) {
    void* found = in_libraries(name);
    const int window_system = strncmp(name, "gl", 2) != 0 || strncmp(name, "glut", 4) == 0;
    return as_function(found != NULL || window_system ? found : by_get_proc_address(name));
}

SluiceInjectFunction real_of(SluiceInjectHook* hook) {
    SluiceInjectFunction found = __atomic_load_n(&hook->real, __ATOMIC_ACQUIRE);
    if (found == NULL) {
        found = real_function(hook->name);
        __atomic_store_n(&hook->real, found, __ATOMIC_RELEASE);
    }
    return found;
}
