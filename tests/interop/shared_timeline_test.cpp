// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <memory>
#include <thread>

#include "sluice/isolate/shared_timeline.hpp"
#include "sluice/trace.hpp"

namespace sluice::isolate {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kLongNs = 120'000'000'000;
constexpr SluiceDirection kToHost = SLUICE_RENDERER_TO_HOST;
constexpr SluiceDirection kToRenderer = SLUICE_HOST_TO_RENDERER;

class SharedTimelineTest : public ::testing::Test {
  protected:
    void SetUp() override {
        auto made = SharedTimeline::create();
        ASSERT_TRUE(made) << made.error().message();
        ours_ = std::move(made).value();
        auto adopted = SharedTimeline::adopt(UniqueFd(::dup(ours_->fd())));
        ASSERT_TRUE(adopted) << adopted.error().message();
        theirs_ = std::move(adopted).value();
    }
    /// The word of the renderer's counter, written past every check.
    void forge(std::uint64_t value) const {
        constexpr std::size_t kWord = 64;  // of the second direction
        void* page = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, ours_->fd(), 0);
        ASSERT_NE(page, MAP_FAILED);
        reinterpret_cast<std::atomic<std::uint64_t>*>(static_cast<std::byte*>(page) + kWord)->store(value);
        ::munmap(page, 4096);
    }

    std::unique_ptr<SharedTimeline> ours_, theirs_;
};

TEST_F(SharedTimelineTest, AWaiterSeesWhatTheOtherSidePublishes) {
    std::thread renderer([this] {
        for (std::uint64_t frame = 1; frame <= 200; ++frame) {
            EXPECT_EQ(theirs_->wait(kToRenderer, 2 * frame - 1, kLongNs), WaitEnd::Reached);
            EXPECT_TRUE(theirs_->publish(kToHost, frame));
        }
    });
    for (std::uint64_t frame = 1; frame <= 200; ++frame) {
        EXPECT_TRUE(ours_->publish(kToRenderer, 2 * frame - 1));
        EXPECT_EQ(ours_->wait(kToHost, frame, kLongNs), WaitEnd::Reached);
    }
    renderer.join();
    EXPECT_EQ(ours_->value(kToHost), 200U);
    EXPECT_EQ(ours_->wait(kToHost, 201, 1'000'000), WaitEnd::Timeout);
    EXPECT_EQ(ours_->wait(kToHost, 201, 0), WaitEnd::Timeout);
}

TEST_F(SharedTimelineTest, ACounterOnlyIncreases) {
    ASSERT_TRUE(ours_->publish(kToRenderer, 5));
    EXPECT_THAT(ours_->publish(kToRenderer, 5).error().message(), HasSubstr("the counter is already at 5"));
    EXPECT_FALSE(ours_->publish(kToRenderer, 3));
    EXPECT_EQ(theirs_->value(kToRenderer), 5U);
}

TEST_F(SharedTimelineTest, AWordThatGoesBackOrLeapsIsBroken) {
    ASSERT_TRUE(theirs_->publish(kToHost, 9));
    ASSERT_EQ(ours_->wait(kToHost, 9, kLongNs), WaitEnd::Reached);
    ASSERT_NO_FATAL_FAILURE(forge(8));
    EXPECT_EQ(ours_->wait(kToHost, 9, kLongNs), WaitEnd::Broken);
    EXPECT_EQ(ours_->wait(kToHost, 1, kLongNs), WaitEnd::Broken) << "even where the value would do";
    ASSERT_NO_FATAL_FAILURE(forge(UINT64_MAX));
    EXPECT_EQ(ours_->wait(kToHost, 10, kLongNs), WaitEnd::Broken);
    ASSERT_NO_FATAL_FAILURE(forge(10));
    EXPECT_EQ(ours_->wait(kToHost, 10, kLongNs), WaitEnd::Reached);
}

TEST_F(SharedTimelineTest, AFailureEndsTheWaitWithItsCode) {
    std::thread renderer([this] { theirs_->fail(SLUICE_ERROR_OUT_OF_MEMORY); });
    EXPECT_EQ(ours_->wait(kToHost, 1, kLongNs), WaitEnd::Failed);
    renderer.join();
    EXPECT_EQ(ours_->failure(), SLUICE_ERROR_OUT_OF_MEMORY);
}

TEST_F(SharedTimelineTest, MemoryOfAnotherSizeOrWithoutSealsIsRefused) {
    const auto make = [](off_t size) {
        UniqueFd fd(::memfd_create("page", MFD_CLOEXEC | MFD_ALLOW_SEALING));
        EXPECT_EQ(::ftruncate(fd.get(), size), 0);
        return fd;
    };
    EXPECT_THAT(SharedTimeline::adopt(make(8)).error().message(), HasSubstr("found 8"));
    EXPECT_THAT(SharedTimeline::adopt(make(4096)).error().message(), HasSubstr("found 4096"));
    EXPECT_NE(::ftruncate(ours_->fd(), 8), 0) << "what we gave away must not shrink";
}

TEST_F(SharedTimelineTest, AWaitForAKilledProcessEndsLongBeforeItsDeadline) {
    const pid_t child = ::fork();
    if (child == 0) {
        static_cast<void>(theirs_->publish(kToHost, 1));
        for (;;) {
            ::pause();
        }
    }
    ASSERT_GT(child, 0);
    ASSERT_EQ(ours_->wait(kToHost, 1, kLongNs), WaitEnd::Reached);
    std::thread watcher([this, child] {
        ::kill(child, SIGKILL);
        int status = 0;
        EXPECT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFSIGNALED(status));
        ours_->peerDied();
    });
    const std::uint64_t begin = monotonicNanoseconds();
    EXPECT_EQ(ours_->wait(kToHost, 2, kLongNs), WaitEnd::PeerDead);
    EXPECT_LT(monotonicNanoseconds() - begin, kLongNs / 10);
    watcher.join();
    EXPECT_EQ(ours_->wait(kToHost, 1, kLongNs), WaitEnd::Reached) << "what was reached stays so";
    EXPECT_TRUE(ours_->peerDead());
}

}  // namespace
}  // namespace sluice::isolate
