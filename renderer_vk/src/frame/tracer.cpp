// SPDX-License-Identifier: MIT
#include "frame/tracer.hpp"

#include "sluice/trace.hpp"

namespace sluice::vk {

std::uint64_t Tracer::now() const {
    return on() ? monotonicNanoseconds() : 0;
}

void Tracer::emit(const TracedEvent& event) const {
    if (!on()) {
        return;
    }
    SluiceTraceEvent out{};
    out.struct_size = sizeof(out);
    out.kind = event.kind;
    out.track = event.track;
    out.direction = event.direction;
    out.begin_ns = event.begin_ns;
    out.duration_ns = event.duration_ns;
    out.frame = event.frame;
    out.value = event.value;
    out.bytes = event.bytes;
    out.name = event.name;
    host_->trace(host_->user, &out);
}

}  // namespace sluice::vk
