// SPDX-License-Identifier: MIT
// The real renderer in a process of its own: the same frames, and what is left when that process dies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <thread>

#include "children.hpp"
#include "echo_rig.hpp"
#include "gl_test.hpp"
#include "sluice/abi_sizes.hpp"
#include "sluice/capability_words.hpp"
#include "sluice/ledger/live.hpp"

namespace sluice::host::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class IsolationTest : public EchoTest {
  protected:
    void isolate(const std::optional<FaultPlan>& fault = {}, std::uint64_t call_timeout_ns = 60'000'000'000) {
        library_.reset();
        IsolationConfig config;
        config.program = SLUICE_RENDERER_PROCESS;
        config.plugin = SLUICE_REAL_RENDERER;
        config.fault = fault;
        config.call_timeout_ns = call_timeout_ns;
        Result<PluginLibrary> library = PluginLibrary::isolated(config);
        ASSERT_TRUE(library) << library.error().message();
        library_.emplace(std::move(library).value());
    }
    /// Draws frames until one fails, `most` at most; the screen then holds what the host drew.
    Status framesUntilFailure(int most) {
        for (int i = 0; i < most; ++i) {
            drawStamp(*screen_, host_->frame() + 1, 4);
            const std::vector<float> drawn = readColour(*screen_, nullptr).values;
            Status status = host_->submit(*screen_, echoInput());
            if (status) {
                status = host_->composite(*screen_);
            }
            if (!status) {
                EXPECT_TRUE(readColour(*screen_, nullptr).values == drawn) << "the host's frame is whole";
                return status;
            }
        }
        return {};
    }
};

TEST_F(IsolationTest, FramesAndResizesAreCleanUnderValidation) {
    ASSERT_NO_FATAL_FAILURE(isolate());
    for (const SluiceTimelineKind kind : {SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH}) {
        FluidHostConfig wanted = config();
        wanted.timeline = kind;
        wanted.validation = true;
        ledger::LiveLedger ledger(ledger::LedgerOptions{}, nullptr);
        Trace trace(1U << 14U);
        wanted.trace = &trace;
        wanted.ledger = &ledger;
        ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
        ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
        for (int i = 0; i < 5; ++i) {
            ASSERT_NO_FATAL_FAILURE(frameIsClean());
        }
        ASSERT_TRUE(host_->resize(67, 43));
        ASSERT_NO_FATAL_FAILURE(makeScreen(67, 43));
        ASSERT_NO_FATAL_FAILURE(frameIsClean());
        const Result<SluiceFrameStats> stats = host_->stats(host_->frame());
        ASSERT_TRUE(stats) << stats.error().message();
        EXPECT_EQ(stats.value().validation_messages, 0U);
        EXPECT_EQ(stats.value().cpu_copy_bytes, 0U);
        host_.reset();
        EXPECT_TRUE(ledger.finish(ledger::End::Closed));
        EXPECT_THAT(ledger.findings(), IsEmpty());
        const std::vector<TraceRecord> records = trace.drain();
        EXPECT_TRUE(std::any_of(records.begin(), records.end(), [](const TraceRecord& record) {
            return record.track == SLUICE_TRACK_RENDERER_QUEUE && record.kind == SLUICE_TRACE_PASS;
        })) << "the other process's events arrive";
        for (const TraceRecord& record : records) {
            EXPECT_NE(record.kind, static_cast<std::uint32_t>(SLUICE_TRACE_CPU_COPY));
        }
    }
}

TEST_F(IsolationTest, ProcessesThatDieLeaveTheHostsFrameOneMessageAndNothingElse) {
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    const std::size_t before = children().size();
    int settled = 0;
    for (const FaultKind kind : {FaultKind::KillRenderer, FaultKind::CrashRenderer, FaultKind::KillRenderer}) {
        FaultPlan fault;
        fault.kind = kind;
        fault.frame = 2;
        ASSERT_NO_FATAL_FAILURE(isolate(fault));
        ASSERT_NO_FATAL_FAILURE(makeHost(config()));
        const Status died = framesUntilFailure(3);
        ASSERT_FALSE(died);
        EXPECT_EQ(died.error().code, SLUICE_ERROR_DEVICE_LOST);
        const auto whole = AllOf(HasSubstr("renderer process "), HasSubstr("frame 2"),
                                 HasSubstr(kind == FaultKind::KillRenderer ? "SIGKILL" : "SIGSEGV"));
        EXPECT_THAT(complaints_, ElementsAre(whole));
        complaints_.clear();
        EXPECT_EQ(host_->submit(*screen_, echoInput()).error().code, SLUICE_ERROR_DEVICE_LOST);
        host_.reset();
        EXPECT_THAT(children(), SizeIs(before)) << "no zombie";
        // The library starts another process for the next renderer, and that one lives.
        ASSERT_NO_FATAL_FAILURE(makeHost(config()));
        for (int i = 0; i < 3; ++i) {
            ASSERT_NO_FATAL_FAILURE(frameIsClean());
        }
        host_.reset();
        library_.reset();
        EXPECT_THAT(children(), SizeIs(before));
        settled = settled == 0 ? openDescriptors() : settled;
        EXPECT_TRUE(descriptorsReturnTo(settled)) << openDescriptors() << " instead of " << settled;
    }
}

TEST_F(IsolationTest, TheHostStartsAnotherProcessByItself) {
    FaultPlan fault;
    fault.kind = FaultKind::CrashRenderer;
    fault.frame = 2;
    ASSERT_NO_FATAL_FAILURE(isolate(fault));
    FluidHostConfig wanted = config();
    wanted.recovery = RecoveryPolicy{};
    ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    EXPECT_EQ(framesUntilFailure(3).error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_TRUE(framesUntilFailure(3));
    EXPECT_EQ(host_->renderers(), 2U);
    complaints_.clear();  // of the try, which recovery_test is about
}

TEST_F(IsolationTest, AProcessThatHangsIsKilledAtItsDeadline) {
    const std::vector<pid_t> before = children();
    ASSERT_NO_FATAL_FAILURE(isolate({}, 5'000'000'000));
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    ASSERT_NO_FATAL_FAILURE(makeHost(config()));
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
    std::vector<pid_t> now = children();
    std::erase_if(now, [&](pid_t pid) { return std::count(before.begin(), before.end(), pid) != 0; });
    ASSERT_THAT(now, SizeIs(1));
    ASSERT_EQ(::kill(now.front(), SIGSTOP), 0);
    const Status hung = framesUntilFailure(1);
    ASSERT_FALSE(hung);
    EXPECT_EQ(hung.error().code, SLUICE_ERROR_DEVICE_LOST);
    EXPECT_THAT(hung.error().message(), HasSubstr("is gone; the log says how"));
    EXPECT_THAT(complaints_,
                ElementsAre(HasSubstr("did not answer submit_frame of frame 2 within 5.000 s and was killed")));
    complaints_.clear();
    host_.reset();
    EXPECT_THAT(children(), SizeIs(before.size()));
}

TEST_F(IsolationTest, AProcessThatDiedWhileItWaitedIsNotHandedOut) {
    const std::vector<pid_t> before = children();
    ASSERT_NO_FATAL_FAILURE(isolate());
    std::vector<pid_t> now = children();
    std::erase_if(now, [&](pid_t pid) { return std::count(before.begin(), before.end(), pid) != 0; });
    ASSERT_THAT(now, SizeIs(1));
    ASSERT_EQ(::kill(now.front(), SIGKILL), 0);
    // Until it has ended; the library's own thread may be faster and reap it.
    siginfo_t info{};
    (void)::waitid(P_PID, static_cast<id_t>(now.front()), &info, WEXITED | WNOWAIT);
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    ASSERT_NO_FATAL_FAILURE(makeHost(config()));
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
}

TEST_F(IsolationTest, MoreParticlesThanTheDeviceTakesAreRefusedBeforeOneIsRead) {
    ASSERT_NO_FATAL_FAILURE(isolate());
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    ASSERT_NO_FATAL_FAILURE(makeHost(config()));
    const std::uint32_t most = host_->info().capabilities.reserved[kMaxParticlesWord];
    ASSERT_GT(most, 0U);
    // A page that nobody can read: whoever copies from it fails otherwise, or crashes.
    void* page = ::mmap(nullptr, 4096, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(page, MAP_FAILED);
    auto particles = sized<SluiceParticles>();
    particles.count = most + 1;
    particles.radius = 0.1F;
    particles.position = static_cast<const float*>(page);
    const Status refused = host_->setParticles(particles);
    auto simulation = sized<SluiceSimulation>();
    simulation.particle_count = UINT32_MAX;
    simulation.position = static_cast<const float*>(page);
    EXPECT_THAT(host_->setSimulation(&simulation).error().message(), HasSubstr("expected at most"));
    simulation.particle_count = 1;
    simulation.solid_count = UINT32_MAX;
    simulation.solids = static_cast<const SluiceSolid*>(page);
    EXPECT_THAT(host_->setSimulation(&simulation).error().message(), HasSubstr("expected at most"));
    ::munmap(page, 4096);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, SLUICE_ERROR_UNSUPPORTED);
    EXPECT_THAT(refused.error().message(), HasSubstr("this device takes at most " + std::to_string(most)));
    ASSERT_NO_FATAL_FAILURE(frameIsClean());
}

TEST_F(IsolationTest, ABodyIsDrivenAndReadBackInHereAndOverThere) {
    for (const bool isolated : {false, true}) {
        if (isolated) {
            host_.reset();
            ASSERT_NO_FATAL_FAILURE(isolate());
        }
        ASSERT_NO_FATAL_FAILURE(makeHost(config()));
        SluiceBody body{};
        body.shape = SLUICE_SOLID_SPHERE;
        body.motion = SLUICE_BODY_DRIVEN;
        body.centre[1] = 0.5F;
        std::fill_n(&body.half[0], 3, 0.1F);
        const std::vector<float> position{0.0F, 0.1F, 0.0F};
        auto simulation = sized<SluiceSimulation>();
        simulation.frames_in_flight = simulation.iterations = 1;
        simulation.radius = 0.05F;
        simulation.relaxation = 0.1F;
        simulation.cfl = 0.4F;
        simulation.longest_step = 0.01;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            simulation.low[axis] = -1.0F;
            simulation.high[axis] = 1.0F;
        }
        simulation.position = position.data();
        simulation.bodies = &body;
        simulation.particle_count = simulation.body_count = 1;
        simulation.max_particles = 2;
        ASSERT_TRUE(host_->setSimulation(&simulation));
        EXPECT_EQ(host_->simulationBodies(1).error().code, SLUICE_NOT_READY);
        auto target = sized<SluiceBodyTarget>();
        target.centre[0] = 0.25F;
        target.turn[3] = 1.0F;
        EXPECT_THAT(host_->setBody(1, target).error().message(), HasSubstr("body 1 of 1 is none that is driven"));
        ASSERT_TRUE(host_->setBody(0, target));
        ASSERT_TRUE(host_->simulate(1, 0.125));
        ASSERT_TRUE(host_->waitForSimulation(1, 60'000'000'000));
        const Result<SluiceBodies> bodies = host_->simulationBodies(0);
        ASSERT_TRUE(bodies) << bodies.error().message();
        EXPECT_EQ(bodies.value().count, 1U);
        EXPECT_EQ(bodies.value().value, 1U);
        EXPECT_EQ(bodies.value().bodies[0].centre[0], 0.25F);
        EXPECT_NEAR(bodies.value().bodies[0].velocity[0], 2.0F, 1e-4F);
        // And the fluid begins anew, with more.
        std::vector<float> two{0.0F, 0.1F, 0.0F, 0.2F, 0.1F, 0.0F};
        auto start = sized<SluiceStart>();
        start.particle_count = 2;
        start.position = start.velocity = two.data();
        ASSERT_TRUE(host_->resetSimulation(start));
        ASSERT_TRUE(host_->simulate(2, 0.0));
        ASSERT_TRUE(host_->waitForSimulation(2, 60'000'000'000));
        EXPECT_EQ(host_->simulationStats().value().particle_count, 2U);
        EXPECT_EQ(host_->simulationBodies(2).value().bodies[0].centre[0], 0.0F) << "where it began";
        two[4] = 7.0F;
        EXPECT_THAT(host_->resetSimulation(start).error().message(), HasSubstr("particle 1: expected a position in"));
    }
}

TEST_F(IsolationTest, OneLibraryServesSeveralThreads) {
    ASSERT_NO_FATAL_FAILURE(isolate());
    auto needs = sized<SluiceSceneNeeds>();
    needs.width = needs.height = 64;
    needs.particle_count = 10;
    needs.fluid = echoInput().fluid;
    std::atomic<int> failures = 0;
    std::atomic<int> lines = 0;
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 3; ++i) {
            threads.emplace_back([&] {
                const auto sink = [](void* user, const char*) { ++*static_cast<std::atomic<int>*>(user); };
                auto error = sized<SluiceError>();
                failures += library_->api().explain(&needs, sink, &lines, &error) == SLUICE_OK ? 0 : 1;
            });
        }
    }
    EXPECT_EQ(failures, 0);
    EXPECT_GE(lines, 3);
}

TEST_F(IsolationTest, WhatIsNoProgramOrNoPluginIsSaidByName) {
    IsolationConfig config;
    config.program = "/nowhere/sluice-renderer";
    config.plugin = SLUICE_REAL_RENDERER;
    EXPECT_THAT(PluginLibrary::isolated(config).error().message(), HasSubstr("'/nowhere/sluice-renderer'"));
    config.program = SLUICE_RENDERER_PROCESS;
    config.plugin = "/nowhere/plugin.so";
    EXPECT_THAT(PluginLibrary::isolated(config).error().message(), HasSubstr("'/nowhere/plugin.so'"));
    config.plugin = SLUICE_RENDERER_PROCESS;  // a program, no library
    EXPECT_THAT(PluginLibrary::isolated(config).error().message(),
                HasSubstr("ended with exit code 1 during its start"));
    FaultPlan fault;
    fault.kind = FaultKind::Drop;
    config.plugin = SLUICE_REAL_RENDERER;
    config.fault = fault;
    EXPECT_FALSE(PluginLibrary::isolated(config));
    EXPECT_FALSE(checkFault({FaultKind::KillRenderer, 1, SLUICE_HOST_TO_RENDERER}, SLUICE_TIMELINE_BRIDGED));
}

TEST_F(IsolationTest, ProbesAndPlansCrossToo) {
    ASSERT_NO_FATAL_FAILURE(isolate());
    const ProbeServices probe([](SluiceLogLevel, std::string_view) {});
    auto info = sized<SluiceCreateInfo>();
    info.width = info.height = 64;
    info.image_sets = 1;
    info.host = queryCapabilities();
    auto error = sized<SluiceError>();
    auto found = sized<SluiceRendererCapabilities>();
    ASSERT_EQ(library_->api().describe(&probe.services(), &info, &found, &error), SLUICE_OK) << &error.message[0];
    EXPECT_NE(found.exportable_formats, 0U);
    EXPECT_EQ(library_->api().probe_format(&probe.services(), &info, SLUICE_FORMAT_R32F, 67, 43, &error), SLUICE_OK)
        << &error.message[0];
    EXPECT_EQ(library_->api().probe_format(&probe.services(), &info, 999, 67, 43, &error),
              SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(&error.message[0], HasSubstr("999 is not a SluiceFormat"));
    auto needs = sized<SluiceSceneNeeds>();
    needs.width = needs.height = 64;
    needs.particle_count = 10;
    needs.fluid = echoInput().fluid;
    std::vector<std::string> lines;
    const auto sink = [](void* user, const char* line) {
        static_cast<std::vector<std::string>*>(user)->emplace_back(line);
    };
    ASSERT_EQ(library_->api().explain(&needs, sink, &lines, &error), SLUICE_OK) << &error.message[0];
    EXPECT_FALSE(lines.empty());
}

}  // namespace
}  // namespace sluice::host::test
