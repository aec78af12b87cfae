// SPDX-License-Identifier: MIT
// The table that the shim calls. No exception leaves it, and whatever fails leaves the program as it would be without
// us.
#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "payload/report.hpp"
#include "payload/session.hpp"
#include "payload/sessions.hpp"

namespace sluice::inject {

namespace {

/// All of this process. Never destroyed: threads of the program may draw until the very end.
struct Process {
    Payload payload;
    Sessions sessions;
    std::mutex mutex;                             ///< of what follows
    std::map<const Session*, std::string> texts;  ///< of the report; each written by its session's thread
    std::chrono::steady_clock::time_point reported{};
    std::atomic<std::uint64_t> other_drawables{0};
};
Process* process = nullptr;

void report(Session* session, bool always);

/// It is this thread's for good.
void end(Session& session) noexcept {
    try {
        session.end();
        report(&session, true);
    } catch (const std::exception& fault) {
        (void)std::fprintf(stderr, "sluice inject: at the end of a context: %s\n", fault.what());
    }
}

/// The session of this thread's context, looked up again after every change of context.
struct Here {
    Here() = default;
    Here(const Here&) = delete;
    Here& operator=(const Here&) = delete;
    ~Here() { forget(); }
    void forget() {
        known = false;
        Session* const was = std::exchange(session, nullptr);
        if (was != nullptr && process->sessions.release(*was)) {
            end(*was);
        }
    }
    bool known = false;
    Session* session = nullptr;
};
thread_local Here here;

Session* session() {
    if (here.session != nullptr && here.session->owner() != std::this_thread::get_id()) {
        here.known = false;  // taken over by another thread: the context is current there
    }
    if (!here.known) {
        here.forget();
        const CurrentContext current = currentContext(process->payload.gl);
        here.session = current.context == nullptr ? nullptr : process->sessions.claim(current);
        here.known = true;
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
            here.session = nullptr;
        }
    } catch (...) {
        here.session = nullptr;
    }
}

/// At least as often as somebody may want to read it; a program that is killed leaves the last one.
constexpr std::chrono::milliseconds kReportInterval{500};

/// The first frames are where all is found out, and a program may be killed before the interval has passed.
bool mustBeReported(std::uint64_t frames) {
    return frames <= 64 && std::has_single_bit(frames);
}

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
    process->sessions.visit([&](Session& each, bool free) {
        std::string& text = process->texts[&each];
        if (free && (&each == session || (session == nullptr && each.thread() == std::this_thread::get_id()))) {
            text = contextText(each);
        }
        if (!text.empty()) {
            contexts.push_back(text);
        }
    });
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
        if (session() == nullptr) {
            here.session = &process->sessions.add(std::make_unique<Session>(process->payload, current));
        }
    } catch (const std::exception& fault) {
        (void)std::fprintf(stderr, "sluice inject: no fluid in this context: %s\n", fault.what());
        return;
    }
    withSession([&](Session& at) {
        at.swap(current, route);
        report(&at, mustBeReported(at.frames()));
    });
}

void madeCurrent() {
    here.forget();
}

/// What of it nobody else uses ends here and now, with or without its context.
void retire(const std::function<bool(const CurrentContext&)>& destroyed) noexcept {
    try {
        for (Session* each : process->sessions.retire(destroyed)) {
            end(*each);
        }
    } catch (const std::exception& fault) {
        (void)std::fprintf(stderr, "sluice inject: at the end of a context: %s\n", fault.what());
    }
    here.forget();
}

void destroyContext(std::uint32_t api, void* /*display*/, void* context) {
    retire([&](const CurrentContext& of) { return of.api == api && of.context == context; });
}

/// Whoever had this address has gone by a way that nobody saw, with its display or its thread.
void contextCreated(std::uint32_t api, void* context) {
    retire([&](const CurrentContext& of) { return of.api == api && of.context == context; });
}

void displayEnded(void* display) {
    retire([&](const CurrentContext& of) { return of.api == SLUICE_INJECT_EGL && of.display == display; });
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

void attributesPopped() {
    withSession([](Session& at) {
        at.matrixModeUnknown();
        at.viewportUnknown();
    });
}

void viewportChanged() {
    withSession([](Session& at) { at.viewportUnknown(); });
}

void listCalled() {
    withSession([](Session& at) { at.listCalled(); });
}

void useProgram(std::uint32_t program) {
    withSession([&](Session& at) {
        at.tracker().useProgram(program);
        at.blocksChanged();
    });
}

// Programs are common to contexts, and one that links them may never draw.
void programLinked(std::uint32_t program) {
    process->payload.programs_changed.fetch_add(1, std::memory_order_relaxed);
    withSession([&](Session& at) { at.tracker().programLinked(program); });
}

void programDeleted(std::uint32_t program) {
    process->payload.programs_changed.fetch_add(1, std::memory_order_relaxed);
    withSession([&](Session& at) { at.tracker().programDeleted(program); });
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

void framebuffersDeleted(std::int32_t count, const std::uint32_t* names) {
    withSession([&](Session& at) {
        for (std::int32_t i = 0; names != nullptr && i < count; ++i) {
            at.tracker().framebufferDeleted(names[i]);
        }
    });
}

void listMode(std::uint32_t mode) {
    withSession([&](Session& at) {
        at.tracker().compileList(mode != 0);
        if (mode == 0) {
            at.matrixModeUnknown();  // what was compiled only did not happen
        }
    });
}

void draw(std::uint32_t vertices) {
    withSession([&](Session& at) { at.beforeDraw(vertices); });
}

void clear(std::uint32_t mask) {
    withSession([&](Session& at) { at.beforeClear(mask); });
}

void clearOf(std::uint32_t framebuffer, std::uint32_t mask) {
    withSession([&](Session& at) { at.beforeClearOf(framebuffer, mask); });
}

void blocksChanged() {
    withSession([](Session& at) { at.blocksChanged(); });
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
                                 blocksChanged,
                                 takeError,
                                 attributesPopped,
                                 listCalled,
                                 programLinked,
                                 programDeleted,
                                 framebuffersDeleted,
                                 contextCreated,
                                 displayEnded,
                                 viewportChanged,
                                 clearOf};

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
