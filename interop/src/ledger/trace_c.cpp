// SPDX-License-Identifier: MIT
// sluice_trace.h over LogWriter: nothing here but translation, and a fence that no exception passes.
#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstring>
#include <new>
#include <string>

#include "ledger/log_bytes.hpp"
#include "sluice/ledger/log.hpp"
#include "sluice/sluice_trace.h"

struct SluiceTraceLog {
    std::unique_ptr<sluice::ledger::LogWriter> writer;
    std::atomic<std::uint32_t> actors{0}, syncs{0}, resources{0};
};

namespace {

using namespace sluice::ledger;

static_assert(SLUICE_TRACE_PROCESS == static_cast<int>(ActorKind::Process));
static_assert(SLUICE_TRACE_FENCE == static_cast<int>(SyncKind::Fence));
static_assert(SLUICE_TRACE_TORN == static_cast<int>(Verdict::Torn));
static_assert(SLUICE_TRACE_LISTED_ONLY == kListedOnly);
static_assert(sizeof(SluiceTraceMemory) == sizeof(MemoryFacts));

/// Runs `call`. What it throws (no memory, a mutex that cannot be locked) ends here: the engine goes on.
template <typename Call, typename Answer>
Answer guard(Answer otherwise, const Call& call) noexcept {
    try {
        return call();
    } catch (...) {
        return otherwise;
    }
}
template <typename Call>
void guard(const Call& call) noexcept {
    try {
        call();
    } catch (...) {  // the record is lost
    }
}

void tell(std::string_view sentence, char* why, std::size_t size) {
    if (why != nullptr && size > 0) {
        const std::size_t length = std::min(sentence.size(), size - 1);
        std::memcpy(why, sentence.data(), length);
        why[length] = '\0';
    }
}

std::string_view text(const char* name) {
    return name == nullptr ? std::string_view{} : std::string_view{name};
}

/// The next number below `bound`; SLUICE_TRACE_NONE, without wrapping, when there is none left.
std::uint32_t take(std::atomic<std::uint32_t>& next, std::uint32_t bound) {
    std::uint32_t id = next.load();
    while (id < bound && !next.compare_exchange_weak(id, id + 1)) {
    }
    return id < bound ? id : SLUICE_TRACE_NONE;
}

bool isActor(std::uint32_t id) {
    return id < kMaxActors;
}
bool isObject(std::uint32_t id) {
    return id < kMaxObjects;
}
ActorId owner(std::uint32_t id) {
    return isActor(id) ? static_cast<ActorId>(id) : kNoActor;
}
std::uint64_t layouts(std::uint32_t old_layout, std::uint32_t new_layout) {
    return std::uint64_t{new_layout} << 32U | old_layout;
}

void put(SluiceTraceLog* log, EventKind kind, std::uint32_t actor, std::uint32_t object, std::uint64_t value,
         ActorId aux = 0, std::uint16_t flags = 0, std::uint64_t began_ns = 0) noexcept {
    if (log == nullptr || !isActor(actor) || object == SLUICE_TRACE_NONE) {
        return;
    }
    const std::uint64_t now = sluice_trace_now();
    Event event;
    event.kind = kind;
    event.flags = flags;
    event.actor = static_cast<ActorId>(actor);
    event.aux = aux;
    event.object = object;
    event.value = value;
    event.time_ns = began_ns == 0 ? now : std::min(began_ns, now);
    event.duration_ns = now - event.time_ns;
    guard([&] { log->writer->record(event); });
}

void putObject(SluiceTraceLog* log, EventKind kind, std::uint32_t actor, std::uint32_t object, std::uint64_t value,
               ActorId aux = 0, std::uint16_t flags = 0, std::uint64_t began_ns = 0) noexcept {
    if (isObject(object)) {
        put(log, kind, actor, object, value, aux, flags, began_ns);
    }
}

void putFd(SluiceTraceLog* log, EventKind kind, std::uint32_t actor, int fd) noexcept {
    if (fd >= 0) {
        put(log, kind, actor, static_cast<std::uint32_t>(fd), 0);
    }
}

void putMemory(SluiceTraceLog* log, EventKind kind, std::uint32_t actor, std::uint32_t resource,
               const SluiceTraceMemory* facts) noexcept {
    if (log == nullptr || facts == nullptr || !isActor(actor) || !isObject(resource)) {
        return;
    }
    guard([&] {
        log->writer->memoryFacts(resource, std::bit_cast<MemoryFacts>(*facts));
        put(log, kind, actor, resource, 0);
    });
}

bool isSyncKind(std::uint32_t kind) {
    return kind <= SLUICE_TRACE_FENCE;
}

}  // namespace

extern "C" {

SluiceTraceLog* sluice_trace_open(const char* path, char* why, size_t why_size) {
    // What there is to say when it cannot even be said for want of memory.
    tell("sluice_trace_open: not enough memory", why, why_size);
    return guard(static_cast<SluiceTraceLog*>(nullptr), [&]() -> SluiceTraceLog* {
        if (path == nullptr) {
            tell("sluice_trace_open: the path is NULL (give the path of a file to write)", why, why_size);
            return nullptr;
        }
        auto writer = LogWriter::create(path);
        if (!writer) {
            tell(writer.error().message(), why, why_size);
            return nullptr;
        }
        auto log = std::make_unique<SluiceTraceLog>();
        log->writer = std::move(writer).value();
        tell("", why, why_size);
        return log.release();
    });
}

int sluice_trace_close(SluiceTraceLog* log) {
    if (log == nullptr) {
        return -1;
    }
    const std::unique_ptr<SluiceTraceLog> owned(log);
    return guard(-1, [&] { return owned->writer->close().ok() ? 0 : -1; });
}

void sluice_trace_flush(SluiceTraceLog* log) {
    if (log != nullptr) {
        guard([&] { log->writer->flush(); });
    }
}

int sluice_trace_status(const SluiceTraceLog* log, char* why, size_t why_size) {
    if (log == nullptr) {
        tell("no log is open", why, why_size);
        return -1;
    }
    tell("not enough memory", why, why_size);
    return guard(-1, [&] {
        const sluice::Status status = log->writer->status();
        tell(status ? "" : status.error().message(), why, why_size);
        return status ? 0 : -1;
    });
}

uint64_t sluice_trace_now(void) {
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
            .count());
}

uint32_t sluice_trace_actor(SluiceTraceLog* log, uint32_t kind, const char* name) {
    if (log == nullptr || kind > SLUICE_TRACE_PROCESS) {
        return SLUICE_TRACE_NONE;
    }
    const std::uint32_t id = take(log->actors, kMaxActors);
    if (id != SLUICE_TRACE_NONE) {
        guard([&] { log->writer->declareActor(static_cast<ActorId>(id), static_cast<ActorKind>(kind), text(name)); });
    }
    return id;
}

uint32_t sluice_trace_sync(SluiceTraceLog* log, uint32_t kind, const char* name, uint64_t initial_value,
                           uint32_t flags) {
    if (log == nullptr || !isSyncKind(kind)) {
        return SLUICE_TRACE_NONE;
    }
    const std::uint32_t id = take(log->syncs, kMaxObjects);
    sluice_trace_renew_sync(log, id, kind, name, initial_value, flags);
    return id;
}

void sluice_trace_renew_sync(SluiceTraceLog* log, uint32_t sync, uint32_t kind, const char* name,
                             uint64_t initial_value, uint32_t flags) {
    if (log != nullptr && isObject(sync) && isSyncKind(kind)) {
        guard([&] {
            log->writer->declareSync(sync, static_cast<SyncKind>(kind), text(name), initial_value,
                                     static_cast<std::uint16_t>(flags & kListedOnly));
        });
    }
}

uint32_t sluice_trace_resource(SluiceTraceLog* log, const char* name, uint32_t layout, uint32_t owner_id) {
    if (log == nullptr) {
        return SLUICE_TRACE_NONE;
    }
    const std::uint32_t id = take(log->resources, kMaxObjects);
    if (id != SLUICE_TRACE_NONE) {
        guard([&] { log->writer->declareResource(id, text(name), layout, owner(owner_id)); });
    }
    return id;
}

void sluice_trace_signal(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value) {
    putObject(log, EventKind::Signal, actor, sync, value);
}
void sluice_trace_wait(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value) {
    putObject(log, EventKind::Wait, actor, sync, value);
}
uint64_t sluice_trace_wait_begin(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value) {
    putObject(log, EventKind::WaitBegin, actor, sync, value);
    return sluice_trace_now();
}
void sluice_trace_wait_end(SluiceTraceLog* log, uint32_t actor, uint32_t sync, uint64_t value, uint64_t began_ns,
                           int timed_out) {
    putObject(log, EventKind::Wait, actor, sync, value, 0, static_cast<std::uint16_t>(timed_out != 0 ? kTimedOut : 0),
              began_ns);
}
void sluice_trace_submit(SluiceTraceLog* log, uint32_t thread, uint32_t stream, uint64_t number) {
    if (isActor(stream)) {
        put(log, EventKind::Submit, thread, stream, number);
    }
}

void sluice_trace_read(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint64_t version) {
    putObject(log, EventKind::Read, actor, resource, version);
}
void sluice_trace_write(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint64_t version) {
    putObject(log, EventKind::Write, actor, resource, version);
}
void sluice_trace_release(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t other, uint32_t old_layout,
                          uint32_t new_layout) {
    putObject(log, EventKind::Release, actor, resource, layouts(old_layout, new_layout), owner(other));
}
void sluice_trace_acquire(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t other, uint32_t old_layout,
                          uint32_t new_layout) {
    putObject(log, EventKind::Acquire, actor, resource, layouts(old_layout, new_layout), owner(other));
}
void sluice_trace_layout(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t old_layout,
                         uint32_t new_layout) {
    putObject(log, EventKind::Layout, actor, resource, layouts(old_layout, new_layout), kNoActor);
}
void sluice_trace_names(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint32_t layout) {
    putObject(log, EventKind::Names, actor, resource, layout);
}
void sluice_trace_witness(SluiceTraceLog* log, uint32_t actor, uint32_t resource, uint64_t found, uint32_t verdict) {
    if (verdict <= SLUICE_TRACE_TORN) {
        putObject(log, EventKind::Witness, actor, resource, found, static_cast<ActorId>(verdict));
    }
}

void sluice_trace_export(SluiceTraceLog* log, uint32_t actor, uint32_t resource, const SluiceTraceMemory* facts) {
    putMemory(log, EventKind::Export, actor, resource, facts);
}
void sluice_trace_import(SluiceTraceLog* log, uint32_t actor, uint32_t resource, const SluiceTraceMemory* facts) {
    putMemory(log, EventKind::Import, actor, resource, facts);
}
void sluice_trace_destroy_sync(SluiceTraceLog* log, uint32_t actor, uint32_t sync) {
    putObject(log, EventKind::Destroy, actor, sync, 0, static_cast<ActorId>(ObjectClass::Sync));
}
void sluice_trace_destroy_resource(SluiceTraceLog* log, uint32_t actor, uint32_t resource) {
    putObject(log, EventKind::Destroy, actor, resource, 0, static_cast<ActorId>(ObjectClass::Resource));
}
void sluice_trace_fd_open(SluiceTraceLog* log, uint32_t actor, int fd) {
    putFd(log, EventKind::FdOpen, actor, fd);
}
void sluice_trace_fd_give(SluiceTraceLog* log, uint32_t actor, int fd) {
    putFd(log, EventKind::FdGive, actor, fd);
}
void sluice_trace_fd_close(SluiceTraceLog* log, uint32_t actor, int fd) {
    putFd(log, EventKind::FdClose, actor, fd);
}
void sluice_trace_frame(SluiceTraceLog* log, uint32_t actor, uint64_t number) {
    put(log, EventKind::Frame, actor, 0, number);
}
void sluice_trace_actor_end(SluiceTraceLog* log, uint32_t actor) {
    put(log, EventKind::ActorEnd, actor, 0, 0);
}

}  // extern "C"
