// SPDX-License-Identifier: MIT
// A Sluice that a test owns, and a look at what it draws.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "caller.hpp"

namespace sluice::test {

struct Destroy {
    void operator()(Sluice* fluid) const { sluice_destroy(fluid); }
};
using Fluid = std::unique_ptr<Sluice, Destroy>;

[[nodiscard]] inline Fluid make(const SluiceOptions& options) {
    Sluice* fluid = nullptr;
    EXPECT_EQ(sluice_create(&options, &fluid), SLUICE_OK) << sluice_last_error(nullptr);
    return Fluid(fluid);
}

/// A frame: what changed left, under the wall, and right of it.
struct Seen {
    int wall, open;
};
[[nodiscard]] inline Seen lookAt(Sluice* fluid, GLuint framebuffer) {
    drawRoom();
    const auto before = pixels(framebuffer);
    EXPECT_EQ(frame(fluid, 1.0), SLUICE_OK) << sluice_last_error(fluid);
    const auto after = pixels(framebuffer);
    return {changed(before, after, 0, kWidth / 3), changed(before, after, kWidth / 3, kWidth)};
}

/// The picture of the first frame, in which the fluid is where it was poured. `encode`: with GL_FRAMEBUFFER_SRGB on
/// while Sluice has its turn.
[[nodiscard]] inline std::vector<std::uint8_t> firstFrame(Sluice* fluid, GLuint framebuffer, bool encode = false) {
    const Camera eye = camera();
    EXPECT_EQ(sluice_begin_frame(fluid, eye.view.data(), eye.projection.data(), 1.0), SLUICE_OK);
    drawRoom();
    if (encode) {
        glEnable(GL_FRAMEBUFFER_SRGB);
    }
    EXPECT_EQ(sluice_end_frame(fluid), SLUICE_OK) << sluice_last_error(fluid);
    glDisable(GL_FRAMEBUFFER_SRGB);
    return pixels(framebuffer);
}

[[nodiscard]] inline SluiceStatistics statisticsOf(Sluice* fluid) {
    SluiceStatistics statistics{};
    statistics.struct_size = sizeof(statistics);
    EXPECT_EQ(sluice_statistics(fluid, &statistics), SLUICE_OK);
    return statistics;
}

}  // namespace sluice::test
