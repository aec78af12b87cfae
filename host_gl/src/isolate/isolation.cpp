// SPDX-License-Identifier: MIT
#include "isolate/isolation.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <csignal>
#include <system_error>
#include <utility>

#include "isolate/proxy.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host {

namespace {

/// describe, explain, create and probe_format of the C ABI come without anything that says whose they are. So each live
/// Isolation has a place here and a set of functions of its own.
constexpr std::size_t kPlaces = 8;
std::array<std::atomic<Isolation*>, kPlaces>& places() {
    static std::array<std::atomic<Isolation*>, kPlaces> all{};
    return all;
}

template <std::size_t Place>
struct Functions {
    static Isolation& self() { return *places()[Place].load(); }
    static SluiceResult describe(const SluiceHostServices* host, const SluiceCreateInfo* info,
                                 SluiceRendererCapabilities* capabilities, SluiceError* error) {
        return proxy::describe(self(), host, info, capabilities, error);
    }
    static SluiceResult explain(const SluiceSceneNeeds* needs, SluiceLineSink sink, void* user, SluiceError* error) {
        return proxy::explain(self(), needs, sink, user, error);
    }
    static SluiceResult create(const SluiceHostServices* host, const SluiceCreateInfo* info, SluiceRenderer** renderer,
                               SluiceError* error) {
        return proxy::create(self(), host, info, renderer, error);
    }
    static SluiceResult probeFormat(const SluiceHostServices* host, const SluiceCreateInfo* info, std::uint32_t format,
                                    std::uint32_t width, std::uint32_t height, SluiceError* error) {
        return proxy::probeFormat(self(), host, info, format, width, height, error);
    }
    static void fill(SluiceRendererApi& table) {
        table.describe = describe;
        table.explain = explain;
        table.create = create;
        table.probe_format = probeFormat;
    }
};

template <std::size_t... Place>
void fillFor(std::size_t place, SluiceRendererApi& table, std::index_sequence<Place...> /*all*/) {
    ((Place == place ? Functions<Place>::fill(table) : void()), ...);
}

isolate::Hello helloFor(const IsolationConfig& config) {
    isolate::Hello hello;
    hello.abi_version = SLUICE_ABI_VERSION;
    if (config.fault) {
        const FaultKind kind = config.fault->kind;
        hello.fault_signal = kind == FaultKind::CrashRenderer  ? SIGSEGV
                             : kind == FaultKind::StopRenderer ? SIGSTOP
                                                               : SIGKILL;
        hello.fault_in_submit = kind == FaultKind::KillRenderer ? 0 : 1;
        hello.fault_frame = config.fault->frame;
    }
    return hello;
}

Status checkFile(const std::filesystem::path& path, const char* what, const char* remedy) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("{} '{}'", what, path.string()), "there is no such file",
                     remedy};
    }
    return {};
}

}  // namespace

Result<std::shared_ptr<Isolation>> Isolation::start(const IsolationConfig& config) {
    if (config.fault && !ofProcess(config.fault->kind)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "fault", "it is none of a renderer's process",
                     "give it to FluidHostConfig"};
    }
    if (Status status = checkFile(config.program, "renderer process", "it belongs beside the program"); !status) {
        return status.error();
    }
    if (Status status = checkFile(config.plugin, "renderer plugin", "give the path of a Sluice renderer"); !status) {
        return status.error();
    }
    std::shared_ptr<Isolation> made(new Isolation(config));
    for (std::size_t place = 0; place < kPlaces && made->place_ == SIZE_MAX; ++place) {
        Isolation* none = nullptr;
        if (places()[place].compare_exchange_strong(none, made.get())) {
            made->place_ = place;
        }
    }
    if (made->place_ == SIZE_MAX) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "isolated plugins",
                     fmt::format("{} are loaded, and that is the most", kPlaces), "let go of one"};
    }
    Result<std::unique_ptr<RendererProcess>> first = made->process();
    if (!first) {
        return first.error();
    }
    made->waiting_ = std::move(first).value();
    made->plugin_ = made->waiting_->welcome();
    SluiceRendererApi& table = made->table_;
    table = proxy::rendererFunctions();
    fillFor(made->place_, table, std::make_index_sequence<kPlaces>{});
    table.struct_size = sizeof(table);
    table.abi_version = SLUICE_ABI_VERSION;
    table.name = made->plugin_.name.c_str();
    table.version = made->plugin_.version.c_str();
    return made;
}

Isolation::~Isolation() {
    if (place_ != SIZE_MAX) {
        places()[place_] = nullptr;
    }
}

Result<std::unique_ptr<RendererProcess>> Isolation::process() {
    std::unique_ptr<RendererProcess> waited;
    IsolationConfig config;
    {
        const std::lock_guard lock(mutex_);
        waited = std::exchange(waiting_, nullptr);
        if (waited && waited->alive()) {
            return waited;
        }
        config = config_;
        config_.fault.reset();  // one fault is one process's: the renderer that takes its place lives
    }
    return RendererProcess::start(config, helloFor(config));
}

}  // namespace sluice::host
