// SPDX-License-Identifier: MIT
#include "image/files.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <system_error>

#include "image/module/functions.hpp"

namespace sluice::cli {
namespace {

constexpr const char* kModule = "libsluice_images.so";

Error missing(std::string detail) {
    return Error{SLUICE_ERROR_UNSUPPORTED, "image files", std::move(detail),
                 fmt::format("install {} of the same build beside the program", kModule)};
}

Result<const images::Functions*> open(const std::filesystem::path& path) {
    // Never closed: OpenImageIO has threads and things to do at the end of the process.
    void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
        return missing(dlerror());
    }
    void* symbol = dlsym(module, images::kEntry);
    images::Entry entry = nullptr;
    static_assert(sizeof entry == sizeof symbol);
    std::memcpy(&entry, &symbol, sizeof entry);
    const images::Functions* functions = entry == nullptr ? nullptr : entry();
    if (functions == nullptr || std::strcmp(functions->build, images::kBuild) != 0) {
        return missing(fmt::format("{} is of another build: expected '{}', found '{}'", path.string(), images::kBuild,
                                   functions == nullptr ? "" : functions->build));
    }
    return functions;
}

Result<const images::Functions*> load() {
    std::error_code ignored;
    const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    const std::filesystem::path beside = folder / kModule;
    const std::filesystem::path installed = (folder / "../lib/sluice" / kModule).lexically_normal();
    for (const std::filesystem::path& path : {beside, installed}) {
        if (std::filesystem::exists(path, ignored)) {
            return open(path);
        }
    }
    return missing(fmt::format("not found at {} and {}", beside.string(), installed.string()));
}

const Result<const images::Functions*>& functions() {
    static const Result<const images::Functions*> loaded = load();
    return loaded;
}

}  // namespace

Status imageFilesPossible() {
    return functions() ? Status{} : Status{functions().error()};
}

Status writePng(const std::filesystem::path& path, const host::Pixels& pixels) {
    return functions() ? functions().value()->write_png(path, pixels) : Status{functions().error()};
}

Status writeExr(const std::filesystem::path& path, const LayeredImage& image) {
    return functions() ? functions().value()->write_exr(path, image) : Status{functions().error()};
}

Result<Environment> loadEnvironment(const std::filesystem::path& path) {
    return functions() ? functions().value()->load_environment(path) : Result<Environment>{functions().error()};
}

Result<DepthLayer> readDepthLayer(const std::filesystem::path& path, bool contents) {
    return functions() ? functions().value()->read_depth_layer(path, contents)
                       : Result<DepthLayer>{functions().error()};
}

}  // namespace sluice::cli
