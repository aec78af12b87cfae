// SPDX-License-Identifier: MIT
// Both sides with what they share, made and unmade in the right order.
#pragma once

#include <memory>
#include <optional>

#include "sluice/result.hpp"
#include "stress/book.hpp"
#include "stress/gl/side.hpp"
#include "stress/link.hpp"
#include "stress/plan.hpp"
#include "stress/vk/side.hpp"

namespace sluice::stress {

/// Pinned. Used on one thread.
class Rig {
  public:
    Rig(const Combination& combination, const Shape& shape, std::shared_ptr<Book> book);
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;
    ~Rig();

    /// Makes anew what `rebuild` says, both sides standing still. UNSUPPORTED says what the machine lacks.
    [[nodiscard]] Status build(Rebuild rebuild, std::uint32_t width, std::uint32_t height);
    /// Gives up a queue that does not end: nothing is destroyed any more, the book neither, into which the bridge still
    /// writes.
    void abandon();

    [[nodiscard]] GlSide& gl() { return *gl_; }
    [[nodiscard]] VkSide& vulkan() { return *vulkan_; }
    [[nodiscard]] Link& link() { return *link_; }
    [[nodiscard]] bool built() const { return link_ != nullptr; }
    [[nodiscard]] const Storage& storage() const { return storage_; }

  private:
    [[nodiscard]] Status createSides();
    [[nodiscard]] Status checkBackend() const;
    [[nodiscard]] Status share();

    Combination combination_;
    Storage storage_;
    std::shared_ptr<Book> book_;
    std::unique_ptr<GlSide> gl_;
    std::unique_ptr<VkSide> vulkan_;
    std::unique_ptr<Link> link_;
};

}  // namespace sluice::stress
