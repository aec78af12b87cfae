// SPDX-License-Identifier: MIT
#include "compositor/gpu_timer.hpp"

#include <epoxy/gl.h>

#include <array>

#include "context/profile.hpp"

namespace sluice::host {

namespace {

// A GPU that never finishes must not make the queue grow for ever.
constexpr std::size_t kMostPending = 64;

/// What turns GL_TIMESTAMP into CLOCK_MONOTONIC: read between two looks at the clock; of several tries the tightest.
std::int64_t clockOffset() {
    std::int64_t offset = 0;
    std::uint64_t tightest = ~std::uint64_t{0};
    for (int i = 0; i < 3; ++i) {
        GLint64 gl = 0;
        const std::uint64_t before = monotonicNanoseconds();
        glGetInteger64v(GL_TIMESTAMP, &gl);
        const std::uint64_t after = monotonicNanoseconds();
        if (after - before < tightest) {
            tightest = after - before;
            offset = static_cast<std::int64_t>(before + (after - before) / 2) - gl;
        }
    }
    return offset;
}

/// Results of queries go to the CPU; a query buffer of the host's would take them.
class QueryBufferGuard {
  public:
    QueryBufferGuard() : present_(epoxy_gl_version() >= 44 || epoxy_has_gl_extension("GL_ARB_query_buffer_object")) {
        if (present_) {
            glGetIntegerv(GL_QUERY_BUFFER_BINDING, &buffer_);
            glBindBuffer(GL_QUERY_BUFFER, 0);
        }
    }
    QueryBufferGuard(const QueryBufferGuard&) = delete;
    QueryBufferGuard& operator=(const QueryBufferGuard&) = delete;
    ~QueryBufferGuard() {
        if (present_) {
            glBindBuffer(GL_QUERY_BUFFER, static_cast<GLuint>(buffer_));
        }
    }

  private:
    bool present_;
    GLint buffer_ = 0;
};

}  // namespace

GpuTimer::GpuTimer(Trace* trace) {
    GLint bits = 0;
    if (trace != nullptr && (epoxy_gl_version() >= 33 || epoxy_has_gl_extension("GL_ARB_timer_query"))) {
        glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
    }
    if (bits > 0) {
        trace_ = trace;
        to_monotonic_ = clockOffset();
    }
}

GpuTimer::~GpuTimer() {
    if (glGone()) {
        return;
    }
    for (const Span& span : pending_) {
        const std::array<GLuint, 2> queries{span.first, span.last};
        glDeleteQueries(2, queries.data());
    }
}

void GpuTimer::begin(const char* name, std::uint64_t frame, std::uint64_t bytes) {
    if (trace_ == nullptr || pending_.size() >= kMostPending) {
        return;
    }
    std::array<GLuint, 2> queries{};
    glGenQueries(2, queries.data());
    glQueryCounter(queries[0], GL_TIMESTAMP);
    pending_.push_back({queries[0], queries[1], name, frame, bytes});
    open_ = true;
}

void GpuTimer::end() {
    if (open_) {
        glQueryCounter(pending_.back().last, GL_TIMESTAMP);
        open_ = false;
    }
}

void GpuTimer::collect() {
    if (pending_.empty()) {
        return;
    }
    const QueryBufferGuard guard;
    while (!pending_.empty() && !open_) {
        const Span span = pending_.front();
        GLint available = GL_FALSE;
        glGetQueryObjectiv(span.last, GL_QUERY_RESULT_AVAILABLE, &available);
        if (available == GL_FALSE) {
            return;
        }
        GLuint64 first = 0;
        GLuint64 last = 0;
        glGetQueryObjectui64v(span.first, GL_QUERY_RESULT, &first);
        glGetQueryObjectui64v(span.last, GL_QUERY_RESULT, &last);
        SluiceTraceEvent event{};
        event.struct_size = sizeof(event);
        event.kind = SLUICE_TRACE_PASS;
        event.track = SLUICE_TRACK_HOST_GL;
        event.begin_ns = static_cast<std::uint64_t>(static_cast<std::int64_t>(first) + to_monotonic_);
        event.duration_ns = last - first;
        event.frame = span.frame;
        event.bytes = span.bytes;
        event.name = span.name;
        trace_->record(event);
        const std::array<GLuint, 2> queries{span.first, span.last};
        glDeleteQueries(2, queries.data());
        pending_.pop_front();
    }
}

}  // namespace sluice::host
