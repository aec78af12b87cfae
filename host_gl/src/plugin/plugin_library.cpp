// SPDX-License-Identifier: MIT
#include "sluice/host_gl/plugin_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "isolate/isolation.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/abi_table.hpp"

namespace sluice::host {

namespace {

constexpr const char* kSource = "give the path of a Sluice renderer, such as libsluice_renderer_vk.so";

struct CloseLibrary {
    void operator()(void* handle) const { dlclose(handle); }
};
using Handle = std::unique_ptr<void, CloseLibrary>;

}  // namespace

Result<PluginLibrary> PluginLibrary::load(const std::filesystem::path& path) {
    const std::string thing = fmt::format("renderer plugin '{}'", path.string());
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing, "the file does not exist", kSource};
    }
    if (!std::filesystem::is_regular_file(path, ignored)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing, "is not a regular file", kSource};
    }
    // dlopen searches the library path for a name without a slash; an absolute path says which file is meant.
    const std::filesystem::path absolute = std::filesystem::absolute(path, ignored);
    Handle handle(dlopen(absolute.c_str(), RTLD_NOW | RTLD_LOCAL));
    if (!handle) {
        const char* why = dlerror();
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, thing,
                     fmt::format("cannot be loaded as a shared object: {}", why != nullptr ? why : "no reason given"),
                     kSource};
    }
    void* symbol = dlsym(handle.get(), SLUICE_RENDERER_ENTRY_SYMBOL);
    if (symbol == nullptr) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, thing,
                     fmt::format("does not export '{}'", SLUICE_RENDERER_ENTRY_SYMBOL), kSource};
    }
    const auto entry = reinterpret_cast<SluiceRendererEntry>(symbol);
    const SluiceRendererApi* api = entry(SLUICE_ABI_VERSION);
    if (Status status = checkRendererTable(thing, api); !status) {
        return status.error();
    }
    PluginLibrary library;
    library.handle_ = handle.release();
    library.api_ = std::make_unique<const SluiceRendererApi>(readAbiStruct(*api));
    library.path_ = path;
    return library;
}

Result<PluginLibrary> PluginLibrary::isolated(const IsolationConfig& config) {
    Result<std::shared_ptr<Isolation>> isolation = Isolation::start(config);
    if (!isolation) {
        return isolation.error();
    }
    PluginLibrary library;
    library.isolation_ = std::move(isolation).value();
    library.api_ = std::make_unique<const SluiceRendererApi>(library.isolation_->table());
    library.path_ = config.plugin;
    library.limits_ = limitsOf(config);
    return library;
}

PluginLibrary::PluginLibrary(PluginLibrary&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)),
      isolation_(std::move(other.isolation_)),
      api_(std::move(other.api_)),
      path_(std::move(other.path_)),
      limits_(other.limits_) {}

PluginLibrary& PluginLibrary::operator=(PluginLibrary&& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(isolation_, other.isolation_);
    std::swap(api_, other.api_);
    std::swap(path_, other.path_);
    std::swap(limits_, other.limits_);
    return *this;
}

PluginLibrary::~PluginLibrary() {
    if (handle_ != nullptr) {
        dlclose(handle_);
    }
}

}  // namespace sluice::host
