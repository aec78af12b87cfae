// SPDX-License-Identifier: MIT
#include "frame/image_sets.hpp"

#include <algorithm>
#include <string>

#include "sluice/format.hpp"

namespace sluice::host {

ImageSets::ImageSets(std::uint32_t sets, const ImageTable& images, Trace* trace) : images_(&images), trace_(trace) {
    for (std::uint32_t i = 0; i < sets; ++i) {
        sets_.push_back({HandOff(i, sets), HandOff(i, sets)});
    }
}

ImageSets::Set& ImageSets::of(std::uint64_t frame) {
    return sets_.at(imageSetOf(frame, static_cast<std::uint32_t>(sets_.size())));
}

void ImageSets::traceImages(std::uint64_t frame, SluiceTraceKind kind) const {
    if (trace_ == nullptr) {
        return;
    }
    const std::uint32_t set = imageSetOf(frame, static_cast<std::uint32_t>(sets_.size()));
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        const ImportedImage* image = images_->find(role, set);
        if (image == nullptr) {
            continue;
        }
        const std::string name(toString(static_cast<SluiceImageRole>(role)));
        SluiceTraceEvent event{};
        event.struct_size = sizeof(event);
        event.kind = kind;
        event.track = SLUICE_TRACK_HOST_CPU;
        event.begin_ns = monotonicNanoseconds();
        event.frame = frame;
        event.bytes = image->bytes();
        event.name = name.c_str();
        trace_->record(event);
    }
}

void ImageSets::take(Set& set, std::uint64_t frame) const {
    if (!set.held) {
        traceImages(frame, SLUICE_TRACE_ACQUIRE);
        set.held = true;
    }
}

void ImageSets::give(Set& set, std::uint64_t frame) const {
    traceImages(frame, SLUICE_TRACE_RELEASE);
    set.held = false;
}

std::uint64_t ImageSets::owedBefore(std::uint64_t frame) const {
    return sets_.at(imageSetOf(frame, static_cast<std::uint32_t>(sets_.size()))).owed;
}

void ImageSets::reached(std::uint64_t value) {
    reached_ = std::max(reached_, value);
    for (Set& set : sets_) {
        if (set.owed <= reached_) {
            set.owed = 0;
        }
    }
}

Status ImageSets::beginCapture(std::uint64_t frame) {
    Set& set = of(frame);
    set.before_capture = set.hand_off;
    if (Status status = set.hand_off.hostAcquire(frame, reached_); !status) {
        return status;
    }
    take(set, frame);
    return {};
}

void ImageSets::cancelCapture(std::uint64_t frame) {
    Set& set = of(frame);
    set.hand_off = set.before_capture;
}

Status ImageSets::endCapture(std::uint64_t frame) {
    Set& set = of(frame);
    if (Status status = set.hand_off.hostRelease(frame); !status) {
        return status;
    }
    give(set, frame);
    return {};
}

Status ImageSets::promised(std::uint64_t frame) {
    Set& set = of(frame);
    set.owed = fluidWritten(frame);
    // The renderer takes its two steps in its own time; the order in which it may take them is fixed here.
    if (Status status = set.hand_off.rendererAcquire(frame, gbufferWritten(frame)); !status) {
        return status;
    }
    return set.hand_off.rendererRelease(frame);
}

void ImageSets::abandoned(std::uint64_t frame) {
    Set& set = of(frame);
    set.hand_off.abandon(frame);
    take(set, frame);
}

Status ImageSets::beginComposite(std::uint64_t frame) {
    Set& set = of(frame);
    if (Status status = set.hand_off.hostCompositeBegin(frame, reached_); !status) {
        return status;
    }
    take(set, frame);
    return {};
}

Status ImageSets::endComposite(std::uint64_t frame) {
    return of(frame).hand_off.hostCompositeEnd(frame);
}

void ImageSets::reset() {
    const auto count = static_cast<std::uint32_t>(sets_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        sets_[i] = {HandOff(i, count), HandOff(i, count)};
    }
}

}  // namespace sluice::host
