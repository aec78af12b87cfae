// SPDX-License-Identifier: MIT
// Frames of a host that makes another renderer when it has to.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gl_test.hpp"
#include "ledger_rig.hpp"
#include "sluice/host_gl/recovery.hpp"

namespace sluice::host::test {

class RecoveryTest : public LedgerTest {
  protected:
    [[nodiscard]] FluidHostConfig recovering(SluiceTimelineKind timeline) {
        FluidHostConfig wanted = config();
        wanted.timeline = timeline;
        wanted.recovery = RecoveryPolicy{};
        return wanted;
    }
    void begin(const FluidHostConfig& wanted) {
        ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
        ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    }
    /// As frameIsClean; a frame without fluid must leave the screen as the host drew it.
    bool frameHasFluid() {
        const std::uint64_t stamp = ++drawn_;
        drawStamp(*screen_, stamp, 1);
        const std::vector<float> before = readColour(*screen_, nullptr).values;
        Status status = host_->submit(*screen_, echoInput());
        if (status) {
            status = host_->composite(*screen_);
        }
        if (status) {
            EXPECT_TRUE(inspect(*host_, stamp).clean()) << "frame " << stamp;
        } else {
            EXPECT_EQ(readColour(*screen_, nullptr).values, before) << "frame " << stamp;
            failures_.push_back(status.error().message());
        }
        return status.ok();
    }
    /// 'f' for a frame with fluid, '-' for one without.
    std::string run(int frames) {
        std::string seen;
        for (int i = 0; i < frames; ++i) {
            seen += frameHasFluid() ? 'f' : '-';
        }
        return seen;
    }

    std::uint64_t drawn_ = 0;
};

}  // namespace sluice::host::test
