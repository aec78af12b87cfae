// SPDX-License-Identifier: MIT
// The table that the shim calls. No exception leaves it, and whatever fails leaves the program as it would be without
// us.
#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "payload/report.hpp"
#include "payload/session.hpp"

namespace sluice::inject {

namespace {

/// All of this process. Never destroyed: threads of the program may draw until the very end.
struct Process {
    Payload payload;
    std::mutex mutex;
    std::vector<std::unique_ptr<Session>> sessions;
    std::map<const Session*, std::string> texts;  ///< of the report; each written by its session's thread
    std::uint64_t other_drawables = 0;
    std::chrono::steady_clock::time_point reported{};
};
Process* process = nullptr;

/// The session of this thread's context, looked up again after every change of context.
struct Here {
    bool known = false;
    Session* session = nullptr;
};
thread_local Here here;

Session* sessionOf(std::uint32_t api, const void* context) {
    const std::lock_guard lock(process->mutex);
    const auto found = std::find_if(process->sessions.begin(), process->sessions.end(), [&](const auto& session) {
        return session->identity().api == api && session->identity().context == context && !session->ended();
    });
    return found == process->sessions.end() ? nullptr : found->get();
}

Session* session() {
    if (!here.known) {
        const CurrentContext current = currentContext(process->payload.gl);
        here = {true, current.context == nullptr ? nullptr : sessionOf(current.api, current.context)};
    }
    return here.session;
}

/// Does `what` with the session of this thread, if it has one.
template <typename What>
void withSession(What what) noexcept {
    Session* at = nullptr;
    try {
        at = session();
        if (at != nullptr) {
            what(*at);
        }
    } catch (const std::exception& fault) {
        try {
            if (at != nullptr) {
                at->giveUp(fault.what());
            }
        } catch (...) {
            here = {true, nullptr};
        }
    } catch (...) {
        here = {true, nullptr};
    }
}

/// At least as often as somebody may want to read it; a program that is killed leaves the last one.
constexpr std::chrono::milliseconds kReportInterval{500};

/// `session` is of the calling thread; NULL: all that are.
void report(Session* session, bool always) {
    const std::string& folder = process->payload.settings.report;
    const auto now = std::chrono::steady_clock::now();
    const std::lock_guard lock(process->mutex);
    if (folder.empty() || (!always && now - process->reported < kReportInterval)) {
        return;
    }
    process->reported = now;
    std::vector<std::string> contexts;
    for (const std::unique_ptr<Session>& each : process->sessions) {
        std::string& text = process->texts[each.get()];
        if (each.get() == session || (session == nullptr && each->thread() == std::this_thread::get_id())) {
            text = contextText(*each);
        }
        if (!text.empty()) {
            contexts.push_back(text);
        }
    }
    writeReport(folder, reportText(process->payload, contexts, process->other_drawables));
}

void swap(std::uint32_t /*api*/, void* /*display*/, std::uintptr_t drawable, const char* route) {
    const CurrentContext current = currentContext(process->payload.gl);
    if (current.context == nullptr) {
        return;
    }
    if (drawable != 0 && drawable != current.drawable) {
        ++process->other_drawables;  // another window than the one that this context draws into: no frame of it
        return;
    }
    try {
        if (sessionOf(current.api, current.context) == nullptr) {
            auto made = std::make_unique<Session>(process->payload, current);
            const std::lock_guard lock(process->mutex);
            process->sessions.push_back(std::move(made));
            here.known = false;
        }
    } catch (const std::exception& fault) {
        (void)std::fprintf(stderr, "sluice inject: no fluid in this context: %s\n", fault.what());
        return;
    }
    withSession([&](Session& at) {
        at.swap(current, route);
        report(&at, at.frames() == 1);
    });
}

void madeCurrent() {
    here.known = false;
}

void destroyContext(std::uint32_t api, void* /*display*/, void* context) {
    try {
        if (Session* at = sessionOf(api, context); at != nullptr) {
            at->end();
            report(at, true);
        }
    } catch (const std::exception& fault) {
        (void)std::fprintf(stderr, "sluice inject: at the end of a context: %s\n", fault.what());
    }
    here.known = false;
}

void matrixMode(std::uint32_t mode) {
    constexpr std::uint32_t kModelView = 0x1700;
    constexpr std::uint32_t kProjection = 0x1701;
    withSession([&](Session& at) { at.tracker().matrixMode(mode == kProjection, mode == kModelView); });
}

void matrixChanged() {
    withSession([](Session& at) { at.tracker().matrixChanged(); });
}

void matrixPushed() {
    withSession([](Session& at) { at.matrixPushed(); });
}

void matrixPopped() {
    withSession([](Session& at) { at.tracker().popped(); });
}

void useProgram(std::uint32_t program) {
    withSession([&](Session& at) { at.tracker().useProgram(program); });
}

void uniformMatrix(std::uint32_t program, std::int32_t location, std::int32_t count, std::uint32_t transpose,
                   const float* value) {
    if (count != 1 || value == nullptr) {
        return;  // an array is a skeleton or the cascades of a shadow
    }
    Matrix matrix{};
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        matrix.at(transpose != 0 ? i % 4 * 4 + i / 4 : i) = value[i];
    }
    withSession([&](Session& at) { at.uniform(program, location, matrix); });
}

void bindFramebuffer(std::uint32_t target, std::uint32_t framebuffer) {
    constexpr std::uint32_t kReadFramebuffer = 0x8CA8;
    if (target != kReadFramebuffer) {
        withSession([&](Session& at) { at.beforeBind(framebuffer); });
    }
}

void listMode(std::uint32_t mode) {
    withSession([&](Session& at) { at.tracker().compileList(mode != 0); });
}

void draw(std::uint32_t vertices) {
    withSession([&](Session& at) { at.beforeDraw(vertices); });
}

void clear(std::uint32_t mask) {
    withSession([&](Session& at) { at.beforeClear(mask); });
}

void takeError(std::uint32_t* error) {
    *error = takeKeptError();
}

const SluiceInjectPayload kTable{sizeof(SluiceInjectPayload),
                                 swap,
                                 madeCurrent,
                                 destroyContext,
                                 matrixMode,
                                 matrixChanged,
                                 matrixPushed,
                                 matrixPopped,
                                 useProgram,
                                 uniformMatrix,
                                 bindFramebuffer,
                                 listMode,
                                 draw,
                                 clear,
                                 takeError};

std::string ownFolder() {
    Dl_info info{};
    if (::dladdr(&kTable, &info) == 0 || info.dli_fname == nullptr) {
        return {};
    }
    const std::string path = info.dli_fname;
    return path.substr(0, path.rfind('/') + 1);
}

}  // namespace

}  // namespace sluice::inject

/// NOLINTNEXTLINE(bugprone-exception-escape): nothing below throws but for memory, which is caught
extern "C" __attribute__((visibility("default"))) const SluiceInjectPayload* sluice_inject_entry(
    const SluiceInjectShim* shim) {
    using namespace sluice::inject;
    try {
        if (shim == nullptr || shim->size != sizeof(SluiceInjectShim)) {
            return nullptr;
        }
        auto made = std::make_unique<Process>();
        made->payload.shim = shim;
        made->payload.settings = parseSettings(shim->settings);
        made->payload.gl = loadGlCalls(*shim);
        made->payload.folder = ownFolder();
        const GlCalls& gl = made->payload.gl;
        if (gl.getError == nullptr || gl.getIntegerv == nullptr || gl.getFloatv == nullptr || gl.getString == nullptr ||
            gl.readPixels == nullptr) {
            (void)std::fputs("sluice inject: no fluid in this process: its OpenGL lacks a function of OpenGL 1.0\n",
                             stderr);
            return nullptr;
        }
        process = made.release();
        // At exit the window and its context may be gone already: nothing but the report is done then.
        static const pid_t own = ::getpid();
        (void)std::atexit([] {
            if (::getpid() != own) {
                return;  // a child that was forked and could not exec: neither the report nor the renderer is its own
            }
            try {
                report(nullptr, true);
            } catch (...) {
            }
        });
        return &kTable;
    } catch (const std::exception& fault) {
        (void)std::fprintf(stderr, "sluice inject: no fluid in this process: %s\n", fault.what());
        return nullptr;
    }
}
