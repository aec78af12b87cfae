// SPDX-License-Identifier: MIT
#include "stress/rig.hpp"

#include <fmt/format.h>

#include <utility>

#include "sluice/negotiate.hpp"
#include "stress/process/side.hpp"

namespace sluice::stress {
namespace {

SluiceTimelineKind kindOf(Backend backend) {
    switch (backend) {
        case Backend::Finish:
            return SLUICE_TIMELINE_FINISH;
        case Backend::Native:
            return SLUICE_TIMELINE_NATIVE;
        case Backend::Binary:
            return SLUICE_TIMELINE_BINARY;
        case Backend::Bridged:
            break;
    }
    return SLUICE_TIMELINE_BRIDGED;
}

}  // namespace

Rig::Rig(const Combination& combination, const Shape& shape, std::shared_ptr<Book> book)
    : combination_(combination), book_(std::move(book)) {
    storage_.resource = combination.resource;
    storage_.slots.shape = shape;
}

Rig::~Rig() {
    if (gl_ != nullptr) {
        gl_->clearTimeline();  // signals through the link to the end
    }
    link_.reset();
    gl_.reset();
}

void Rig::abandon() {
    // Each of them would wait for the queue; the process ends soon.
    (void)link_.release();
    (void)gl_.release();
    (void)vulkan_.release();
}

Status Rig::createSides() {
    gl_.reset();
    vulkan_.reset();
    auto gl = GlSide::create();
    if (!gl) {
        return gl.error();
    }
    gl_ = std::move(gl).value();
    if (const std::string missing = gl_->missingFor(combination_.resource); !missing.empty()) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("--resource {}", toString(combination_.resource)), missing,
                     ""};
    }
    auto vulkan = combination_.topology == Topology::TwoProcesses ? startVkProcess(gl_->capabilities())
                                                                  : VkSide::create(gl_->capabilities());
    if (!vulkan) {
        return vulkan.error();
    }
    vulkan_ = std::move(vulkan).value();
    return checkBackend();
}

Status Rig::checkBackend() const {
    NegotiationRequest request;
    request.timeline = kindOf(combination_.backend);
    const Result<Agreement> agreed = negotiate(gl_->capabilities(), vulkan_->capabilities(), request);
    if (!agreed) {
        Error error = agreed.error();
        error.remedy = "take --backend bridged or finish";
        return error;
    }
    if (combination_.backend == Backend::Native || combination_.backend == Backend::Binary) {
        return Error{SLUICE_ERROR_UNSUPPORTED, fmt::format("--backend {}", toString(combination_.backend)),
                     "the drivers could, but the stress test cannot drive it yet", "take --backend bridged or finish"};
    }
    return {};
}

Status Rig::share() {
    std::vector<ExportedSlot> exported;
    for (std::uint32_t slot = 0; slot < storage_.slots.shared(); ++slot) {
        auto one = vulkan_->exportSlot(slot);
        if (!one) {
            return one.error();
        }
        exported.push_back(std::move(one).value());
    }
    return gl_->allocate(storage_, std::move(exported));
}

Status Rig::build(Rebuild rebuild, std::uint32_t width, std::uint32_t height) {
    if (rebuild == Rebuild::Nothing) {
        return {};
    }
    if (gl_ != nullptr) {
        gl_->clearTimeline();
    }
    link_.reset();
    if (gl_ != nullptr) {
        gl_->clear();
    }
    if (rebuild == Rebuild::Everything) {
        if (Status status = createSides(); !status) {
            return status;
        }
    }
    storage_.width = width;
    storage_.height = height;
    if (Status status = vulkan_->allocate(storage_); !status) {
        return status;
    }
    if (Status status = share(); !status) {
        return status;
    }
    book_->declare(storage_);
    link_ = std::make_unique<Link>(*vulkan_, book_, storage_.slots.shape.relay);
    return gl_->makeTimeline(combination_.backend, combination_.topology, link_->api(), link_->renderer());
}

}  // namespace sluice::stress
