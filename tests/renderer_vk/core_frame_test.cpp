// SPDX-License-Identifier: MIT
// Frames: order, statistics, events, particles that change while frames run, and a silent validation layer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "core_fake_host.hpp"
#include "sluice/trace.hpp"

namespace sluice::vk::test {
namespace {

constexpr std::uint64_t kLong = 60'000'000'000;

/// Drives frames as a bridged host does: promise, submit, keep the promise, wait, composite.
class Frames : public ::testing::Test {
  protected:
    void start(bool tracing, SluiceTimelineKind kind = SLUICE_TIMELINE_BRIDGED, std::uint32_t sets = 2,
               std::uint32_t validation = 1, bool readable = false) {
        renderer.reset();  // before the host that it refers to
        host = std::make_unique<FakeHost>(tracing);
        host->keep_descriptors = readable;
        info = host->createInfo();
        info.timeline = static_cast<std::uint32_t>(kind);
        info.validation = validation;
        info.image_sets = sets;
        info.outputs = SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);
        renderer = std::make_unique<TestRenderer>(*host, info);
        ASSERT_EQ(renderer->result(), SLUICE_OK) << renderer->error().message;
    }

    void submit(const SluiceFrame& frame) {
        ASSERT_EQ(renderer->submit(frame), SLUICE_OK) << "frame " << frame.frame << ": " << renderer->error().message;
    }
    void signal(std::uint64_t value) { ASSERT_EQ(api().timeline_signal(renderer->get(), value), SLUICE_OK) << value; }
    void wait(std::uint64_t value) {
        ASSERT_EQ(api().timeline_wait(renderer->get(), value, kLong), SLUICE_OK) << value;
    }
    void run(const SluiceFrame& frame) {
        submit(frame);
        signal(frame.wait_value);
        wait(frame.signal_value);
        signal(frame.wait_value + 1);
    }
    SluiceFrameStats stats(std::uint64_t frame) {
        auto out = sized<SluiceFrameStats>();
        EXPECT_EQ(api().poll(renderer->get(), frame, &out), SLUICE_OK) << frame;
        return out;
    }
    void setParticles(const ParticleCloud& cloud) {
        auto error = sized<SluiceError>();
        ASSERT_EQ(api().set_particles(renderer->get(), &cloud.particles, &error), SLUICE_OK) << error.message;
    }

    std::unique_ptr<FakeHost> host;
    SluiceCreateInfo info{};
    std::unique_ptr<TestRenderer> renderer;
};

TEST_F(Frames, TwoHundredFramesOfEveryViewWithoutAValidationMessage) {
    start(false);
    const ParticleCloud few(40);
    const ParticleCloud more(200);
    constexpr SluiceView kViews[] = {SLUICE_VIEW_ECHO, SLUICE_VIEW_FLUID, SLUICE_VIEW_DEPTH, SLUICE_VIEW_NORMAL,
                                     SLUICE_VIEW_THICKNESS};
    for (std::uint64_t k = 1; k <= 200; ++k) {
        if (k % 20 == 5) {
            setParticles(k % 40 == 5 ? few : more);
        }
        if (k == 100) {
            ASSERT_EQ(api().resize(renderer->get(), 71, 37, nullptr), SLUICE_OK);
        }
        // The view changes seldom enough that frames overlap, and often enough that plans follow each other.
        SluiceFrame frame = frameOf(k, info.image_sets, kViews[(k / 8) % std::size(kViews)]);
        if (k % 50 > 25) {
            frame.outputs = info.outputs;
        }
        submit(frame);
        signal(frame.wait_value);
        if (k > 1) {
            wait(k - 1);
        }
    }
    wait(200);
    EXPECT_EQ(stats(200).validation_messages, 0U);
    renderer->destroy();
    for (const std::string& line : host->log()) {
        EXPECT_EQ(line.find("validation:"), std::string::npos) << line;
    }
}

TEST_F(Frames, EveryPassHasItsOwnBarriers) {
    // The timer's barrier before each pass, which lavapipe needs, would hide a missing one from the validation layer.
    const Switched off({.no_timer_barrier = true});
    start(false);
    const ParticleCloud cloud(200);
    setParticles(cloud);
    std::uint64_t k = 0;
    for (const SluiceView view : {SLUICE_VIEW_ECHO, SLUICE_VIEW_FLUID, SLUICE_VIEW_DEPTH, SLUICE_VIEW_NORMAL,
                                  SLUICE_VIEW_THICKNESS, SLUICE_VIEW_FLUID}) {
        for (int times = 0; times < 4; ++times) {
            SluiceFrame frame = frameOf(++k, info.image_sets, view);
            frame.outputs = times % 2 == 0 ? info.outputs : 0;
            run(frame);
        }
    }
    const SluiceFrameStats found = stats(k);
    EXPECT_GE(found.pass_count, 4U) << "the whole frame";
    EXPECT_EQ(found.validation_messages, 0U);
}

TEST_F(Frames, StagedAndDirectUploadsGiveTheSamePicture) {
    const ParticleCloud cloud(300);
    std::vector<std::byte> colour[2];
    std::vector<std::byte> depth[2];
    for (const bool staged : {false, true}) {
        const Switched path({.stage_uploads = staged});
        start(false, SLUICE_TIMELINE_BRIDGED, 2, 1, true);
        setParticles(cloud);
        for (std::uint64_t k = 1; k <= 3; ++k) {  // the first one uploads; the others only use what it left
            SluiceFrame frame = frameOf(k, 2, SLUICE_VIEW_FLUID);
            run(frame);
            EXPECT_EQ(stats(k).upload_bytes, k == 1 ? 300U * 3 * sizeof(float) : 0U);
        }
        EXPECT_EQ(stats(3).validation_messages, 0U);
        colour[staged ? 1 : 0] = host->texels(SLUICE_IMAGE_FLUID_COLOUR, 0);
        depth[staged ? 1 : 0] = host->texels(SLUICE_IMAGE_FLUID_DEPTH, 0);
    }
    ASSERT_FALSE(colour[0].empty());
    EXPECT_TRUE(std::any_of(colour[0].begin(), colour[0].end(), [](std::byte b) { return b != std::byte{0}; }))
        << "there is fluid in the picture";
    EXPECT_EQ(colour[0], colour[1]);
    EXPECT_EQ(depth[0], depth[1]);
}

TEST_F(Frames, EveryCpuKindRunsFramesInOrder) {
    for (const SluiceTimelineKind kind : {SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH}) {
        for (std::uint32_t sets = 1; sets <= SLUICE_MAX_IMAGE_SETS; ++sets) {
            start(false, kind, sets);
            for (std::uint64_t k = 1; k <= 6; ++k) {
                const SluiceFrame frame = frameOf(k, sets);
                signal(frame.wait_value);
                submit(frame);
                if (kind == SLUICE_TIMELINE_FINISH) {
                    std::uint64_t now = 0;
                    ASSERT_EQ(api().timeline_value(renderer->get(), SLUICE_RENDERER_TO_HOST, &now), SLUICE_OK);
                    EXPECT_EQ(now, k) << "the queue is idle before submit_frame returns";
                }
                wait(k);
                signal(frame.wait_value + 1);
            }
            EXPECT_EQ(stats(6).validation_messages, 0U);
        }
    }
}

TEST_F(Frames, FinishRefusesAFrameWhoseSignalHasNotCome) {
    start(false, SLUICE_TIMELINE_FINISH);
    EXPECT_EQ(renderer->submit(frameOf(1, 2)), SLUICE_ERROR_INVALID_ARGUMENT);
    signal(1);
    submit(frameOf(1, 2));
}

TEST_F(Frames, AFrameDoesNotRunBeforeItsSignalUnlessTold) {
    start(false);
    submit(frameOf(1, 2));
    auto out = sized<SluiceFrameStats>();
    EXPECT_EQ(api().poll(renderer->get(), 1, &out), SLUICE_NOT_READY);
    EXPECT_EQ(api().timeline_wait(renderer->get(), 1, 30'000'000), SLUICE_TIMEOUT);
    signal(1);
    wait(1);
    SluiceFrame unsynchronised = frameOf(2, 2);
    unsynchronised.flags = SLUICE_FRAME_SKIP_WAIT;
    submit(unsynchronised);
    wait(2);
    EXPECT_EQ(stats(2).frame, 2U);
}

TEST_F(Frames, StatisticsAreKeptForTheLastSetsAndPlausible) {
    start(false, SLUICE_TIMELINE_BRIDGED, 2);
    const ParticleCloud cloud(500);
    setParticles(cloud);
    for (std::uint64_t k = 1; k <= 4; ++k) {
        run(frameOf(k, 2, SLUICE_VIEW_FLUID));
    }
    auto old = sized<SluiceFrameStats>();
    EXPECT_EQ(api().poll(renderer->get(), 2, &old), SLUICE_ERROR_INVALID_ARGUMENT) << "replaced by frame 4";
    for (const std::uint64_t k : {3U, 4U}) {
        const SluiceFrameStats found = stats(k);
        EXPECT_EQ(found.struct_size, sizeof(found));
        EXPECT_EQ(found.frame, k);
        EXPECT_EQ(found.cpu_copy_bytes, 0U);
        ASSERT_GE(found.pass_count, 4U);
        ASSERT_LE(found.pass_count, SLUICE_MAX_PASSES);
        bool particles_seen = false;
        for (std::uint32_t i = 0; i < found.pass_count; ++i) {
            const SluicePassStats& pass = found.passes[i];
            EXPECT_NE(pass.name[0], '\0');
            EXPECT_GT(pass.elements, 0U) << pass.name;
            EXPECT_GT(pass.bytes, 0U) << pass.name;
            EXPECT_GT(pass.dispatches, 0U) << pass.name;
            EXPECT_LT(pass.nanoseconds, kLong) << pass.name;
            if (pass.is_particles != 0) {
                particles_seen = true;
                EXPECT_EQ(pass.elements, 500U) << pass.name;
            }
        }
        EXPECT_TRUE(particles_seen);
    }
}

TEST_F(Frames, AnUploadIsCountedForTheFirstFrameThatUsesIt) {
    start(false);
    const ParticleCloud cloud(100);
    setParticles(cloud);
    run(frameOf(1, 2, SLUICE_VIEW_FLUID));
    run(frameOf(2, 2, SLUICE_VIEW_FLUID));
    EXPECT_EQ(stats(1).upload_bytes, 100U * 3 * sizeof(float));
    EXPECT_EQ(stats(2).upload_bytes, 0U);
}

TEST_F(Frames, NewParticlesDoNotDisturbFramesInFlight) {
    start(false);
    const ParticleCloud first(300);
    const ParticleCloud second(20);
    setParticles(first);
    submit(frameOf(1, 2, SLUICE_VIEW_FLUID));  // waits for the host, and so cannot have read its particles yet
    setParticles(second);
    setParticles(first);
    setParticles(second);
    signal(1);
    wait(1);
    signal(3);
    submit(frameOf(2, 2, SLUICE_VIEW_FLUID));
    wait(2);
    const auto particlesOf = [&](std::uint64_t k) {
        const SluiceFrameStats found = stats(k);
        const auto* end = found.passes + found.pass_count;
        const auto* pass =
            std::find_if(found.passes, end, [](const SluicePassStats& p) { return p.is_particles != 0; });
        return pass == end ? 0 : pass->elements;
    };
    EXPECT_EQ(particlesOf(1), 300U);
    EXPECT_EQ(particlesOf(2), 20U);
    EXPECT_EQ(stats(2).validation_messages, 0U);
}

TEST_F(Frames, TheTraceTellsTheHandOff) {
    start(true);
    const ParticleCloud cloud(50);
    setParticles(cloud);
    const std::uint64_t before = monotonicNanoseconds();
    for (std::uint64_t k = 1; k <= 3; ++k) {
        run(frameOf(k, 2, SLUICE_VIEW_FLUID));
        (void)stats(k);
    }
    const std::uint64_t after = monotonicNanoseconds();
    std::map<std::uint64_t, std::map<std::uint32_t, std::vector<SluiceTraceEvent>>> frames;
    for (const SeenEvent& seen : host->events()) {
        EXPECT_EQ(seen.event.struct_size, sizeof(SluiceTraceEvent));
        if (seen.event.kind == SLUICE_TRACE_CPU_COPY) {
            EXPECT_EQ(seen.name, "particle upload") << "the only copy that a frame loop may show";
            EXPECT_EQ(seen.event.bytes, 50U * 3 * sizeof(float));
            continue;
        }
        frames[seen.event.frame][seen.event.kind].push_back(seen.event);
    }
    for (std::uint64_t k = 1; k <= 3; ++k) {
        auto& kinds = frames[k];
        ASSERT_EQ(kinds[SLUICE_TRACE_SUBMIT].size(), 1U);
        ASSERT_EQ(kinds[SLUICE_TRACE_WAIT].size(), 1U);
        ASSERT_EQ(kinds[SLUICE_TRACE_SIGNAL].size(), 1U);
        EXPECT_EQ(kinds[SLUICE_TRACE_ACQUIRE].size(), 6U);
        EXPECT_EQ(kinds[SLUICE_TRACE_RELEASE].size(), 6U);
        ASSERT_GE(kinds[SLUICE_TRACE_PASS].size(), 4U);
        const SluiceTraceEvent& wait = kinds[SLUICE_TRACE_WAIT][0];
        const SluiceTraceEvent& signal = kinds[SLUICE_TRACE_SIGNAL][0];
        EXPECT_EQ(wait.value, 2 * k - 1);
        EXPECT_EQ(wait.direction, std::uint32_t{SLUICE_HOST_TO_RENDERER});
        EXPECT_EQ(signal.value, k);
        EXPECT_EQ(signal.direction, std::uint32_t{SLUICE_RENDERER_TO_HOST});
        // One clock: passes lie between the queue's wait and its signal, and all of it within this test.
        EXPECT_GE(wait.begin_ns, before);
        EXPECT_LE(signal.begin_ns, after);
        for (const SluiceTraceEvent& pass : kinds[SLUICE_TRACE_PASS]) {
            EXPECT_GE(pass.begin_ns, wait.begin_ns);
            EXPECT_LE(pass.begin_ns + pass.duration_ns, signal.begin_ns);
        }
        EXPECT_GE(kinds[SLUICE_TRACE_ACQUIRE][0].bytes, 64U * 48U * 4U);
    }
}

TEST_F(Frames, WithoutATraceNothingIsTraced) {
    start(false);
    run(frameOf(1, 2));
    (void)stats(1);
    EXPECT_TRUE(host->events().empty());
}

}  // namespace
}  // namespace sluice::vk::test
