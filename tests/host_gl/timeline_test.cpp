// SPDX-License-Identifier: MIT
// The host's end of the CPU-side timelines, against a renderer that is two counters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "gl_test.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/ledger/live.hpp"
#include "timeline/cpu_wait.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::host::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

/// Records what is signalled; waits on a counter of its own.
struct FakeRenderer {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<std::uint64_t> signalled;
    std::map<std::uint64_t, GLsync> work;  // of each value, made before it was promised
    std::uint64_t to_host = 0;
    std::uint64_t fail_value = 0;  // timeline_signal of this value fails
    int early = 0;                 // values signalled before their work was done

    static FakeRenderer& of(SluiceRenderer* renderer) {
        FakeRenderer* fake = nullptr;
        std::memcpy(&fake, &renderer, sizeof(fake));
        return *fake;
    }
    SluiceRenderer* handle() {
        FakeRenderer* self = this;
        SluiceRenderer* renderer = nullptr;
        std::memcpy(&renderer, &self, sizeof(renderer));
        return renderer;
    }
    static SluiceResult signal(SluiceRenderer* renderer, std::uint64_t value) {
        FakeRenderer& self = of(renderer);
        const std::lock_guard lock(self.mutex);
        if (const auto found = self.work.find(value); found != self.work.end()) {
            const GLenum state = glClientWaitSync(found->second, 0, 0);
            self.early += state == GL_ALREADY_SIGNALED ? 0 : 1;
        }
        if (value == self.fail_value) {
            return SLUICE_ERROR_DEVICE_LOST;
        }
        self.signalled.push_back(value);
        self.changed.notify_all();
        return SLUICE_OK;
    }
    static SluiceResult wait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
        FakeRenderer& self = of(renderer);
        std::unique_lock lock(self.mutex);
        const bool there =
            self.changed.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [&] { return self.to_host >= value; });
        return there ? SLUICE_OK : SLUICE_TIMEOUT;
    }
    static SluiceResult exportFd(SluiceRenderer* /*renderer*/, std::uint32_t /*direction*/, std::uint64_t /*value*/,
                                 std::int32_t* /*fd*/, SluiceError* /*error*/) {
        return SLUICE_ERROR_UNSUPPORTED;
    }
    /// Waits until `count` values have been signalled; false after ten seconds.
    bool until(std::size_t count) {
        std::unique_lock lock(mutex);
        return changed.wait_for(lock, std::chrono::seconds(10), [&] { return signalled.size() >= count; });
    }
};

class TimelineTest : public GlTest {
  protected:
    void SetUp() override {
        GlTest::SetUp();
        api_.timeline_signal = &FakeRenderer::signal;
        api_.timeline_wait = &FakeRenderer::wait;
        api_.timeline_export = &FakeRenderer::exportFd;
        Result<Screen> screen = Screen::create(256, 256);
        ASSERT_TRUE(screen);
        screen_.emplace(std::move(screen).value());
        screen_->bind();
    }
    void TearDown() override {
        for (const auto& [value, fence] : fake_.work) {
            glDeleteSync(fence);
        }
        screen_.reset();
    }
    std::unique_ptr<HostTimeline> make(SluiceTimelineKind kind, std::uint64_t drain_timeout_ns = 2'000'000'000ULL) {
        TimelineDeps deps;
        deps.api = &api_;
        deps.renderer = fake_.handle();
        deps.trace = &trace_;
        deps.drain_timeout_ns = drain_timeout_ns;
        Result<std::unique_ptr<HostTimeline>> timeline = makeHostTimeline(kind, deps);
        EXPECT_TRUE(timeline) << timeline.error().message();
        return timeline ? std::move(timeline).value() : nullptr;
    }
    /// Draws, fences the drawing and says whether it was still running then.
    bool drawFenced(std::uint64_t value, int layers) {
        drawHeavily(layers);
        const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        glFlush();
        const std::lock_guard lock(fake_.mutex);
        fake_.work[value] = fence;
        return glClientWaitSync(fence, 0, 0) == GL_TIMEOUT_EXPIRED;
    }

    SluiceRendererApi api_{};
    FakeRenderer fake_;
    Trace trace_{4096};
    std::optional<Screen> screen_;
};

double secondsSince(steady_clock::time_point begin) {
    return std::chrono::duration<double>(steady_clock::now() - begin).count();
}

class OrderedTimeline : public TimelineTest, public ::testing::WithParamInterface<SluiceTimelineKind> {};

TEST_P(OrderedTimeline, SignalsEveryValueInOrderAndOnlyAfterItsWork) {
    std::vector<std::uint64_t> expected;
    int running = 0;
    {
        const std::unique_ptr<HostTimeline> timeline = make(GetParam());
        ASSERT_NE(timeline, nullptr);
        EXPECT_EQ(timeline->kind(), GetParam());
        for (std::uint64_t value = 1; value <= 12; ++value) {
            running += drawFenced(value, 60) ? 1 : 0;
            const Status status = timeline->signal(value, {});
            ASSERT_TRUE(status) << status.error().message();
            expected.push_back(value);
        }
        ASSERT_TRUE(fake_.until(expected.size()));
    }
    EXPECT_THAT(fake_.signalled, ElementsAreArray(expected));
    EXPECT_EQ(fake_.early, 0);
    EXPECT_GT(running, 0) << "the work was too light to show anything";
    int signals = 0;
    for (const TraceRecord& record : trace_.drain()) {
        if (record.kind == SLUICE_TRACE_SIGNAL) {
            ++signals;
            EXPECT_EQ(record.track,
                      GetParam() == SLUICE_TIMELINE_BRIDGED ? SLUICE_TRACK_BRIDGE : SLUICE_TRACK_HOST_CPU);
            EXPECT_EQ(record.direction, SLUICE_HOST_TO_RENDERER);
            EXPECT_EQ(record.frame, (record.value + 1) / 2);
        }
    }
    EXPECT_EQ(signals, 12);
}

TEST_P(OrderedTimeline, WaitReturnsOnceTheCounterIsThere) {
    const std::unique_ptr<HostTimeline> timeline = make(GetParam());
    ASSERT_NE(timeline, nullptr);
    std::thread renderer([&] {
        std::this_thread::sleep_for(milliseconds(30));
        const std::lock_guard lock(fake_.mutex);
        fake_.to_host = 5;
        fake_.changed.notify_all();
    });
    const Status status = timeline->wait(5, 10'000'000'000ULL, {});
    renderer.join();
    EXPECT_TRUE(status) << status.error().message();
}

TEST_P(OrderedTimeline, WaitGivesUpAfterItsTimeout) {
    const std::unique_ptr<HostTimeline> timeline = make(GetParam());
    ASSERT_NE(timeline, nullptr);
    const auto begin = steady_clock::now();
    const Status status = timeline->wait(1, 120'000'000ULL, {});
    const double seconds = secondsSince(begin);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, SLUICE_TIMEOUT);
    EXPECT_THAT(status.error().message(), HasSubstr("did not reach 1 within 0.120 s"));
    EXPECT_GE(seconds, 0.119);
    EXPECT_LT(seconds, 5.0);
}

INSTANTIATE_TEST_SUITE_P(Cpu, OrderedTimeline, ::testing::Values(SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH));

TEST_F(TimelineTest, BridgeDrainsWhatWasPromisedWhenClosed) {
    {
        const std::unique_ptr<HostTimeline> timeline = make(SLUICE_TIMELINE_BRIDGED, 60'000'000'000ULL);
        ASSERT_NE(timeline, nullptr);
        for (std::uint64_t value = 1; value <= 8; ++value) {
            drawFenced(value, 60);
            ASSERT_TRUE(timeline->signal(value, {}));
        }
    }
    EXPECT_EQ(fake_.signalled.size(), 8U);
    EXPECT_EQ(fake_.early, 0);
}

TEST_F(TimelineTest, BridgeThatMayNotWaitLetsTheRendererGoOnAndCloses) {
    const auto begin = steady_clock::now();
    {
        const std::unique_ptr<HostTimeline> timeline = make(SLUICE_TIMELINE_BRIDGED, 0);
        ASSERT_NE(timeline, nullptr);
        for (std::uint64_t value = 1; value <= 4; ++value) {
            drawFenced(value, 400);
            ASSERT_TRUE(timeline->signal(value, {}));
        }
    }
    EXPECT_LT(secondsSince(begin), 20.0);
    // Every value, or a queue that waits for one would never end.
    EXPECT_EQ(fake_.signalled.size(), 4U);
}

TEST_F(TimelineTest, FailureOfTheBridgeEndsAWaitAndIsToldOnce) {
    const std::unique_ptr<HostTimeline> timeline = make(SLUICE_TIMELINE_BRIDGED);
    ASSERT_NE(timeline, nullptr);
    fake_.fail_value = 1;
    ASSERT_TRUE(timeline->signal(1, {}));
    const auto begin = steady_clock::now();
    // The renderer never answers, because it never heard of value 1: the failure, not the timeout, must end the wait.
    const Status status = timeline->wait(1, 60'000'000'000ULL, {});
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(status.error().message(), HasSubstr("signalling 1 failed with code -6"));
    EXPECT_LT(secondsSince(begin), 30.0);
    EXPECT_TRUE(timeline->signal(2, {}));
    ASSERT_TRUE(fake_.until(1));
    EXPECT_THAT(fake_.signalled, ElementsAreArray({2}));
}

TEST_F(TimelineTest, ALostRendererThatTakesNoLastValueIsNoWarning) {
    std::vector<SluiceLogLevel> told;
    TimelineDeps deps;
    deps.api = &api_;
    deps.renderer = fake_.handle();
    deps.log = [&](SluiceLogLevel level, std::string_view) { told.push_back(level); };
    fake_.fail_value = 1;
    {
        Result<std::unique_ptr<HostTimeline>> timeline = makeHostTimeline(SLUICE_TIMELINE_BRIDGED, deps);
        ASSERT_TRUE(timeline) << timeline.error().message();
        ASSERT_TRUE(timeline.value()->signal(1, {}));
    }
    EXPECT_THAT(told, ::testing::ElementsAre(SLUICE_LOG_INFO));
}

TEST_F(TimelineTest, AWaitWithoutHopeIsGivenUpAndNotTakenForADeadline) {
    ledger::LiveLedger ledger;
    std::vector<std::string> told;
    const std::atomic<bool> hopeless = true;
    {
        ledger::HandOffFeed feed(ledger, SLUICE_TIMELINE_BRIDGED, 2);
        TimelineDeps deps;
        deps.api = &api_;
        deps.renderer = fake_.handle();
        deps.feed = &feed;
        deps.log = [&](SluiceLogLevel, std::string_view text) { told.emplace_back(text); };
        const Status status = waitOnCpu(deps, 1, 60'000'000'000ULL, &hopeless);
        ASSERT_FALSE(status);
        EXPECT_EQ(status.error().code, SLUICE_ERROR_DEVICE_LOST);
        EXPECT_THAT(status.error().message(), HasSubstr("gave up waiting for 1"));
    }
    EXPECT_TRUE(ledger.finish(ledger::End::Closed));
    EXPECT_TRUE(ledger.findings().empty()) << ledger.findings().front().sentence;
    EXPECT_TRUE(told.empty()) << told.front();
}

TEST_F(TimelineTest, UnsynchronisedPromisesWithoutWaiting) {
    const std::unique_ptr<HostTimeline> timeline = make(SLUICE_TIMELINE_UNSYNCHRONISED);
    ASSERT_NE(timeline, nullptr);
    drawFenced(1, 400);
    ASSERT_TRUE(timeline->signal(1, {}));
    EXPECT_EQ(fake_.early, 1) << "the work was too light, or somebody waited for it";
    EXPECT_TRUE(timeline->wait(1000, 60'000'000'000ULL, {}));
}

TEST_F(TimelineTest, SemaphoreBackendsNameTheMissingExtension) {
    if (epoxy_has_gl_extension("GL_EXT_semaphore_fd")) {
        GTEST_SKIP() << "this driver has GL semaphores";
    }
    TimelineDeps deps;
    deps.api = &api_;
    deps.renderer = fake_.handle();
    const auto native = makeHostTimeline(SLUICE_TIMELINE_NATIVE, deps);
    ASSERT_FALSE(native);
    EXPECT_THAT(native.error().message(), HasSubstr("GL_NV_timeline_semaphore"));
    const auto binary = makeHostTimeline(SLUICE_TIMELINE_BINARY, deps);
    ASSERT_FALSE(binary);
    EXPECT_THAT(binary.error().message(), HasSubstr("GL_EXT_semaphore"));
    EXPECT_FALSE(makeHostTimeline(SLUICE_TIMELINE_AUTO, deps));
}

}  // namespace
}  // namespace sluice::host::test
