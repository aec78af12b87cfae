// SPDX-License-Identifier: MIT
// File descriptors that run out at every possible moment of a start and of a resize: an error or a renderer, nothing
// left behind, and the number that is enough.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>

#include "gl_test.hpp"
#include "recovery_rig.hpp"
#include "sluice/fd.hpp"

namespace sluice::host::test {
namespace {

using ::testing::HasSubstr;

// More than any start was seen to need; a search that gets here has found a hang-up.
constexpr int kMostTried = 96;

/// While it lives, so many descriptors can be opened and no more.
class OnlyDescriptors {
  public:
    explicit OnlyDescriptors(int count) {
        const UniqueFd lowest{open("/dev/null", O_RDONLY | O_CLOEXEC)};
        EXPECT_EQ(getrlimit(RLIMIT_NOFILE, &before_), 0);
        rlimit scarce = before_;
        scarce.rlim_cur = static_cast<rlim_t>(lowest.get() + count);
        EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &scarce), 0);
    }
    OnlyDescriptors(const OnlyDescriptors&) = delete;
    OnlyDescriptors& operator=(const OnlyDescriptors&) = delete;
    ~OnlyDescriptors() { EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &before_), 0); }

  private:
    rlimit before_{};
};

class Scarcity : public RecoveryTest {
  protected:
    void SetUp() override {
        ASSERT_NO_FATAL_FAILURE(RecoveryTest::SetUp());
        ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
        EXPECT_EQ(run(2), "ff");
        host_.reset();
        drawn_ = 0;
    }
};

TEST_F(Scarcity, AStartWithTooFewDescriptorsFailsAndLeavesNothing) {
    const int before = openDescriptors();
    const FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
    int enough = -1;
    for (int count = 0; count < kMostTried && enough < 0; ++count) {
        SCOPED_TRACE(count);
        bool created = false;
        std::string message;
        {
            // Nothing is judged in here: clang's UBSan needs a pipe to look at the matcher's type.
            const OnlyDescriptors scarce(count);
            const auto host = FluidHost::create(*library_, wanted);
            created = host.ok();
            message = created ? "" : host.error().message();
        }
        if (!created) {
            EXPECT_THAT(message, HasSubstr("file descriptors"));
        }
        enough = created ? count : -1;
        EXPECT_TRUE(descriptorsReturnTo(before)) << openDescriptors() << " instead of " << before;
    }
    ASSERT_GE(enough, 1);
    RecordProperty("descriptors", enough);
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    EXPECT_EQ(run(2), "ff");
    complaints_.clear();
}

TEST_F(Scarcity, AResizeWithTooFewDescriptorsIsMadeUpForWhenThereAreSomeAgain) {
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
    wanted.recovery.settled_frames = 1;
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    EXPECT_EQ(run(2), "ff");
    const int before = openDescriptors();
    bool succeeded = false;
    for (int count = 0; count < kMostTried && !succeeded; ++count) {
        SCOPED_TRACE(count);
        const std::uint32_t width = 64 + static_cast<std::uint32_t>(count);
        {
            const OnlyDescriptors scarce(count);
            succeeded = host_->resize(width, 48).ok();
        }
        ASSERT_NO_FATAL_FAILURE(makeScreen(width, 48));
        EXPECT_EQ(run(2), "ff");
        EXPECT_EQ(host_->info().width, width);
        EXPECT_TRUE(descriptorsReturnTo(before)) << openDescriptors() << " instead of " << before;
    }
    EXPECT_TRUE(succeeded);
    complaints_.clear();
}

}  // namespace
}  // namespace sluice::host::test
