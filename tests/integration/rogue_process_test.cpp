// SPDX-License-Identifier: MIT
// A renderer's process that behaves as no honest one does: it is ended, with one message, and the host goes on.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <string>
#include <thread>

#include "children.hpp"
#include "isolate/renderer_process.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::chrono::seconds kLong{60};

class IsolatedRogue : public ::testing::Test {
  public:
    /// Waits until the log has a line.
    bool said() {
        std::unique_lock lock(mutex_);
        return said_.wait_for(lock, kLong, [this] { return !lines_.empty(); });
    }
    /// A log that does not return before somebody says so.
    void sayAndWait(const char* text) {
        std::unique_lock lock(mutex_);
        lines_.emplace_back(text);
        was_released_ = said_.wait_for(lock, kLong, [this] { return released_; });
    }

  protected:
    void SetUp() override {
        services_.user = this;
        services_.log = [](void* user, std::int32_t /*level*/, const char* text) {
            auto& self = *static_cast<IsolatedRogue*>(user);
            if (self.throws_ > 0) {
                --self.throws_;
                throw std::bad_alloc();
            }
            const std::lock_guard lock(self.mutex_);
            self.lines_.emplace_back(text);
            self.said_.notify_all();
        };
        services_.retire_image = [](void* /*user*/, std::uint32_t /*role*/, std::uint32_t /*image_set*/) {};
    }
    // A short deadline is set once it has started: under load, that takes a while.
    void start(const char* what, std::uint64_t call_timeout_ns = 60'000'000'000, ChildWatch watch = {}) {
        IsolationConfig config;
        config.program = SLUICE_ROGUE_PROCESS;
        config.plugin = what;
        config.call_timeout_ns = call_timeout_ns;
        auto started = RendererProcess::start(config, isolate::Hello{}, std::move(watch));
        ASSERT_TRUE(started) << started.error().message();
        process_ = std::move(started).value();
        process_->passTo(&services_);
    }
    Result<Reply> call() { return process_->call(isolate::Info{}, {}, "info", {&services_, nullptr, nullptr}); }
    Result<Reply> explain(SluiceLineSink sink) {
        return process_->call(isolate::Explain{}, {}, "explain", {nullptr, sink, this});
    }
    SluiceHostServices services_ = sized<SluiceHostServices>();
    std::mutex mutex_;
    std::condition_variable said_;
    std::vector<std::string> lines_;
    std::atomic<int> throws_{0};
    bool released_ = false, was_released_ = false;
    std::unique_ptr<RendererProcess> process_;
};

TEST_F(IsolatedRogue, OneThatSigkillCannotEndIsLeftBehind) {
    const std::size_t before = children().size();
    ChildWatch watch;
    watch.wait = [](pid_t /*pid*/, int* /*status*/) { return pid_t{0}; };
    watch.after_kill_ns = 50'000'000;
    ASSERT_NO_FATAL_FAILURE(start("works", 60'000'000'000, watch));
    process_->condemn("did what it must not and was killed");
    EXPECT_EQ(call().error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_TRUE(process_->timeline().peerDead());
    process_.reset();
    EXPECT_THAT(lines_, ElementsAre(AllOf(HasSubstr("did what it must not and was killed, but has not ended 0.050 s"),
                                          HasSubstr("stuck in the kernel"))));
    // This one does end, and the thread that it was left to reaps it.
    for (int i = 0; i < 6000 && children().size() != before; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_THAT(children(), SizeIs(before));
}

TEST_F(IsolatedRogue, CallbacksOfOneCallHaveAnEnd) {
    ASSERT_NO_FATAL_FAILURE(start("asks"));
    EXPECT_EQ(call().error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(lines_, ElementsAre(HasSubstr("called back more than 4096 times during info and was killed")));
}

TEST_F(IsolatedRogue, LinesThatNobodyReadsArePiledUpToABound) {
    ASSERT_NO_FATAL_FAILURE(start("lines"));
    const auto sleeper = [](void* user, const char* /*line*/) {
        EXPECT_TRUE(static_cast<IsolatedRogue*>(user)->said()) << "they pile up for ever";
    };
    EXPECT_EQ(explain(sleeper).error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(lines_, ElementsAre(HasSubstr("sent more than 1024 lines that nobody had read yet and was killed")));
}

TEST_F(IsolatedRogue, AnswersThatNobodyAskedForEndIt) {
    ASSERT_NO_FATAL_FAILURE(start("answers"));
    EXPECT_TRUE(call());
    EXPECT_TRUE(said()) << "they pile up for ever";
    EXPECT_EQ(call().error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(lines_, ElementsAre(HasSubstr("sent a returned that nobody had asked for and was killed")));
}

TEST_F(IsolatedRogue, OneAnswerTooManyIsNotKeptForTheNextCall) {
    ASSERT_NO_FATAL_FAILURE(start("twice"));
    EXPECT_TRUE(call());
    EXPECT_TRUE(said());
    EXPECT_THAT(lines_, ElementsAre(HasSubstr("sent a returned that nobody had asked for and was killed")));
}

TEST_F(IsolatedRogue, AMessageWithoutAByteIsNoEnd) {
    ASSERT_NO_FATAL_FAILURE(start("empty"));
    EXPECT_EQ(call().error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(lines_, ElementsAre(AllOf(HasSubstr("sent what is no message and was killed"),
                                          HasSubstr("a message of 0 bytes came"))));
}

TEST_F(IsolatedRogue, OneThatClosesItsChannelAndLivesIsBlamedAndEnded) {
    ChildWatch watch;
    watch.grace_ns = 50'000'000;
    ASSERT_NO_FATAL_FAILURE(start("half-closed", 60'000'000'000, watch));
    EXPECT_EQ(call().error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_TRUE(process_->timeline().peerDead());
    EXPECT_THAT(lines_,
                ElementsAre(HasSubstr("closed its channel, did not end within 0.05 s and was killed during info")));
}

TEST_F(IsolatedRogue, ALogThatWaitsForTheCallersThreadDoesNotHangIt) {
    services_.log = [](void* user, std::int32_t /*level*/, const char* text) {
        static_cast<IsolatedRogue*>(user)->sayAndWait(text);
    };
    ChildWatch watch;
    watch.telling_ns = 50'000'000;
    ASSERT_NO_FATAL_FAILURE(start("works", 60'000'000'000, watch));
    process_->condemn("did what it must not and was killed");
    EXPECT_THAT(call().error().message(), HasSubstr("did what it must not and was killed"));
    {
        const std::lock_guard lock(mutex_);
        released_ = true;
    }
    said_.notify_all();
    process_.reset();
    EXPECT_TRUE(was_released_) << "the call came back only after the log had";
    EXPECT_THAT(lines_, SizeIs(1));
}

TEST_F(IsolatedRogue, TheDeadlineIsThatOfTheWholeCall) {
    ASSERT_NO_FATAL_FAILURE(start("slow-lines"));
    process_->limitCalls(1'000'000'000);
    EXPECT_EQ(explain([](void*, const char*) {}).error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(lines_, ElementsAre(HasSubstr("did not answer explain within 1.000 s and was killed")));
}

TEST_F(IsolatedRogue, ADeadlineWithoutEndIsOneOfADay) {
    ASSERT_NO_FATAL_FAILURE(start("works", UINT64_MAX));
    EXPECT_TRUE(call());
}

TEST_F(IsolatedRogue, OneThatReceivesNoMoreIsEnded) {
    ASSERT_NO_FATAL_FAILURE(start("deaf"));
    EXPECT_EQ(call().error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(lines_, ElementsAre(HasSubstr("would not take info, though it lives, and was killed")));
}

TEST_F(IsolatedRogue, MemoryThatRunsOutOnTheListeningThreadCostsTheRenderer) {
    ASSERT_NO_FATAL_FAILURE(start("talks"));
    throws_ = 1;
    EXPECT_EQ(call().error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(lines_, ElementsAre(HasSubstr("was killed: this process found no memory to listen to it")));
    ASSERT_NO_FATAL_FAILURE(start("talks"));
    lines_.clear();
    throws_ = 1'000'000;  // there is none for the last line either
    EXPECT_THAT(call().error().message(), HasSubstr("was killed: this process found no memory to listen to it"));
    EXPECT_THAT(lines_, IsEmpty());
}

TEST_F(IsolatedRogue, AProcessOutlivesTheThreadThatStartedIt) {
    std::thread([this] { start("works"); }).join();
    ASSERT_NE(process_, nullptr);
    // The kernel tells a thread's end to its children some time after it can be joined.
    for (int i = 0; i < 50; ++i) {
        const Result<Reply> reply = call();
        ASSERT_TRUE(reply) << reply.error().message();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

/// While it lives this process has only the standard streams of `kept`, a bit each.
class Streams {
  public:
    explicit Streams(unsigned kept) {
        for (int fd = 0; fd < 3; ++fd) {
            if ((kept >> static_cast<unsigned>(fd) & 1U) == 0) {
                saved_.at(static_cast<std::size_t>(fd)) = ::fcntl(fd, F_DUPFD_CLOEXEC, 100);
                ::close(fd);
            }
        }
    }
    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;
    ~Streams() {
        for (int fd = 0; fd < 3; ++fd) {
            if (const int saved = saved_.at(static_cast<std::size_t>(fd)); saved >= 0) {
                ::dup2(saved, fd);
                ::close(saved);
            }
        }
    }

  private:
    std::array<int, 3> saved_{-1, -1, -1};
};

TEST_F(IsolatedRogue, AHostWithoutStandardStreamsStartsOneThatHasThem) {
    for (unsigned kept = 0; kept < 8; ++kept) {
        std::uint64_t found = 0;
        unsigned taken = 0;
        std::string failure;
        {
            const Streams streams(kept);
            IsolationConfig config;
            config.program = SLUICE_ROGUE_PROCESS;
            config.plugin = "works";
            auto started = RendererProcess::start(config, isolate::Hello{});
            for (unsigned fd = 0; fd < 3; ++fd) {
                taken |= ::fcntl(static_cast<int>(fd), F_GETFD) >= 0 ? 1U << fd : 0U;
            }
            if (started) {
                auto reply = started.value()->call(isolate::Info{}, {}, "info", {});
                found = reply ? reply.value().returned.value : 0;
                failure = reply ? "" : reply.error().message();
            } else {
                failure = started.error().message();
            }
        }
        EXPECT_EQ(failure, "") << kept;
        EXPECT_EQ(found, 7U) << kept;
        EXPECT_EQ(taken, kept) << "what is printed would go into the channel, the timeline or the process's descriptor";
    }
}

}  // namespace
}  // namespace sluice::host::test
