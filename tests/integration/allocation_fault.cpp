// SPDX-License-Identifier: MIT
// Replaces operator new of the whole program, drivers' libraries included; only who is ours is ever refused.
#include "allocation_fault.hpp"

#include <execinfo.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace {

struct Range {
    std::uintptr_t begin = 0, end = 0;
    [[nodiscard]] bool has(const void* address) const {
        const auto at = reinterpret_cast<std::uintptr_t>(address);
        return at >= begin && at < end;
    }
};

// Fixed sizes: this must not allocate.
struct Modules {
    std::array<Range, 4> ours{};       // the program, the renderer's library, the shim
    std::array<Range, 4> passed_by{};  // libraries of templates and text, which allocate for whoever calls them
    std::size_t our_count = 0, passed_count = 0;
};

Modules modules;
thread_local bool armed = false;
thread_local std::uint64_t target = 0;
thread_local std::uint64_t count = 0;
thread_local bool has_failed = false;

int note(dl_phdr_info* info, std::size_t /*size*/, void* data) {
    auto& first = *static_cast<bool*>(data);
    const char* name = info->dlpi_name;
    const bool program = std::exchange(first, false);
    const bool ours = program || std::strstr(name, "libsluice_") != nullptr;
    const bool passed = std::strstr(name, "libstdc++") != nullptr || std::strstr(name, "libfmt") != nullptr;
    if (!ours && !passed) {
        return 0;
    }
    Range range{UINTPTR_MAX, 0};
    for (int i = 0; i < info->dlpi_phnum; ++i) {
        const ElfW(Phdr)& part = info->dlpi_phdr[i];
        if (part.p_type == PT_LOAD && (part.p_flags & PF_X) != 0) {
            range.begin = std::min<std::uintptr_t>(range.begin, info->dlpi_addr + part.p_vaddr);
            range.end = std::max<std::uintptr_t>(range.end, info->dlpi_addr + part.p_vaddr + part.p_memsz);
        }
    }
    if (ours && modules.our_count < modules.ours.size()) {
        modules.ours.at(modules.our_count++) = range;
    } else if (passed && modules.passed_count < modules.passed_by.size()) {
        modules.passed_by.at(modules.passed_count++) = range;
    }
    return 0;
}

template <typename Ranges>
bool within(const Ranges& ranges, const void* address) {
    return std::any_of(ranges.begin(), ranges.end(), [&](const Range& range) { return range.has(address); });
}

/// Whether Sluice's code has asked for the memory, given who called operator new.
bool askedByUs(const void* caller) {
    if (!within(modules.passed_by, caller)) {
        return within(modules.ours, caller);
    }
    std::array<void*, 16> frames{};
    const int depth = backtrace(frames.data(), static_cast<int>(frames.size()));
    bool past = false;  // the frames of this file and of operator new come first, and they are the program's, too
    for (int i = 0; i < depth; ++i) {
        const void* frame = frames.at(static_cast<std::size_t>(i));
        if (within(modules.passed_by, frame)) {
            past = true;
        } else if (past) {
            return within(modules.ours, frame);
        }
    }
    return false;
}

bool refuses(const void* caller) {
    if (!armed) {
        return false;
    }
    armed = false;  // backtrace may allocate
    const bool ours = askedByUs(caller);
    armed = true;
    if (!ours || ++count != target) {
        return false;
    }
    has_failed = true;
    return true;
}

void* take(std::size_t size, std::size_t alignment) {
    const std::size_t wanted = std::max<std::size_t>(size, 1);
    if (alignment <= alignof(std::max_align_t)) {
        return std::malloc(wanted);
    }
    return std::aligned_alloc(alignment, (wanted + alignment - 1) / alignment * alignment);
}

void* takeOrThrow(std::size_t size, std::size_t alignment, const void* caller) {
    void* block = refuses(caller) ? nullptr : take(size, alignment);
    if (block == nullptr) {
        throw std::bad_alloc();
    }
    return block;
}

}  // namespace

void* operator new(std::size_t size) {
    return takeOrThrow(size, 0, __builtin_return_address(0));
}
void* operator new[](std::size_t size) {
    return takeOrThrow(size, 0, __builtin_return_address(0));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return takeOrThrow(size, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return takeOrThrow(size, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return refuses(__builtin_return_address(0)) ? nullptr : take(size, 0);
}
void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return refuses(__builtin_return_address(0)) ? nullptr : take(size, 0);
}
void operator delete(void* block) noexcept {
    std::free(block);
}
void operator delete[](void* block) noexcept {
    std::free(block);
}
void operator delete(void* block, std::size_t /*size*/) noexcept {
    std::free(block);
}
void operator delete[](void* block, std::size_t /*size*/) noexcept {
    std::free(block);
}
void operator delete(void* block, std::align_val_t /*alignment*/) noexcept {
    std::free(block);
}
void operator delete[](void* block, std::align_val_t /*alignment*/) noexcept {
    std::free(block);
}
void operator delete(void* block, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
    std::free(block);
}
void operator delete[](void* block, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
    std::free(block);
}

namespace sluice::host::test {

FailingAllocation::FailingAllocation(std::uint64_t nth) {
    std::array<void*, 2> frames{};
    (void)backtrace(frames.data(), 2);  // loads what it needs now and not in the middle of an allocation
    modules = Modules{};
    bool first = true;
    dl_iterate_phdr(&note, &first);
    target = nth;
    count = 0;
    has_failed = false;
    armed = true;
}

FailingAllocation::~FailingAllocation() {
    armed = false;
}

std::uint64_t FailingAllocation::counted() const {
    return count;
}

bool FailingAllocation::failed() const {
    return has_failed;
}

}  // namespace sluice::host::test
