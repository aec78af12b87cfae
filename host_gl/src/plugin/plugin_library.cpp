// SPDX-License-Identifier: MIT
#include "sluice/host_gl/plugin_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "isolate/isolation.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host {

namespace {

constexpr const char* kSource = "give the path of a Sluice renderer, such as libsluice_renderer_vk.so";
constexpr const char* kRebuild = "build host and plugin from the same sluice/plugin.h";

struct CloseLibrary {
    void operator()(void* handle) const { dlclose(handle); }
};
using Handle = std::unique_ptr<void, CloseLibrary>;

/// The first function of ABI 1.0 that is NULL, or nullptr.
const char* firstMissing(const SluiceRendererApi& api) {
    const std::array<std::pair<const char*, bool>, 16> present{{
        {"describe", api.describe != nullptr},
        {"explain", api.explain != nullptr},
        {"create", api.create != nullptr},
        {"info", api.info != nullptr},
        {"resize", api.resize != nullptr},
        {"set_particles", api.set_particles != nullptr},
        {"set_environment", api.set_environment != nullptr},
        {"submit_frame", api.submit_frame != nullptr},
        {"poll", api.poll != nullptr},
        {"timeline_signal", api.timeline_signal != nullptr},
        {"timeline_wait", api.timeline_wait != nullptr},
        {"timeline_value", api.timeline_value != nullptr},
        {"timeline_export", api.timeline_export != nullptr},
        {"probe_format", api.probe_format != nullptr},
        {"destroy", api.destroy != nullptr},
        {"name", api.name != nullptr},
    }};
    for (const auto& [name, is_present] : present) {
        if (!is_present) {
            return name;
        }
    }
    return nullptr;
}

constexpr std::uint32_t majorOf(std::uint32_t version) {
    return version >> 16U;
}

Status checkTable(const std::string& thing, const SluiceRendererApi* api) {
    if (api == nullptr) {
        return Error{
            SLUICE_ERROR_ABI_MISMATCH, thing,
            fmt::format("does not serve ABI {}.{}: its entry returned no table", SLUICE_ABI_MAJOR, SLUICE_ABI_MINOR),
            kRebuild};
    }
    // The version stands before the functions, so it can be read whatever the size of the rest.
    constexpr std::size_t kHead = offsetof(SluiceRendererApi, abi_version) + sizeof(std::uint32_t);
    if (api->struct_size < kHead || majorOf(api->abi_version) != SLUICE_ABI_MAJOR) {
        const std::uint32_t found = api->struct_size < kHead ? 0 : majorOf(api->abi_version);
        return Error{SLUICE_ERROR_ABI_MISMATCH, thing,
                     fmt::format("expected ABI major {}, found {}", SLUICE_ABI_MAJOR, found), kRebuild};
    }
    if (api->struct_size < kAbiMinimum<SluiceRendererApi>) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, thing,
                     fmt::format("expected a function table of at least {} bytes, found {}",
                                 kAbiMinimum<SluiceRendererApi>, api->struct_size),
                     kRebuild};
    }
    if (const char* missing = firstMissing(*api)) {
        return Error{SLUICE_ERROR_ABI_MISMATCH, thing, fmt::format("the function table has NULL for '{}'", missing),
                     kRebuild};
    }
    return {};
}

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
    if (Status status = checkTable(thing, api); !status) {
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
    return library;
}

PluginLibrary::PluginLibrary(PluginLibrary&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)),
      isolation_(std::move(other.isolation_)),
      api_(std::move(other.api_)),
      path_(std::move(other.path_)) {}

PluginLibrary& PluginLibrary::operator=(PluginLibrary&& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(isolation_, other.isolation_);
    std::swap(api_, other.api_);
    std::swap(path_, other.path_);
    return *this;
}

PluginLibrary::~PluginLibrary() {
    if (handle_ != nullptr) {
        dlclose(handle_);
    }
}

}  // namespace sluice::host
