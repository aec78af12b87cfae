// SPDX-License-Identifier: MIT
// The renderer's end of the channel, driven by a host that keeps to nothing.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <thread>
#include <utility>
#include <vector>

#include "sluice/abi_sizes.hpp"
#include "sluice/isolate/channel.hpp"
#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/isolate/server.hpp"
#include "sluice/isolate/shared_timeline.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::isolate {
namespace {

using ::testing::HasSubstr;

constexpr std::uint64_t kLongNs = 60'000'000'000;

/// A renderer without a device: it notes what it is called with. One at a time.
struct FakeRenderer {
    SluiceHostServices services{};
    std::atomic<std::uint64_t> host_value{0}, own_value{0};
    std::uint64_t signals = 0;
    float last_colour = 0, last_solid = 0, last_velocity = 0;
    std::uint32_t last_fluid = 0;
    double simulated = 0.0;
    std::vector<float> words;  ///< the last one of each array of a simulation
    int destroyed = 0;
};
FakeRenderer fake;

SluiceRendererApi fakeApi() {
    auto api = sized<SluiceRendererApi>();
    api.abi_version = SLUICE_ABI_VERSION;
    api.name = "fake";
    api.version = "7";
    api.create = [](const SluiceHostServices* host, const SluiceCreateInfo* /*info*/, SluiceRenderer** renderer,
                    SluiceError* error) {
        fake.services = *host;
        *renderer = reinterpret_cast<SluiceRenderer*>(&fake);
        auto image = sized<SluiceImageExport>();
        image.role = SLUICE_IMAGE_FLUID_COLOUR;
        image.fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        const SluiceResult result = host->share_image(host->user, &image, error);
        if (result != SLUICE_OK) {
            ::close(image.fd);
        }
        return result;
    };
    api.info = [](SluiceRenderer* /*renderer*/, SluiceRendererInfo* info) -> SluiceResult {
        info->timeline = SLUICE_TIMELINE_BRIDGED;
        return SLUICE_OK;
    };
    api.set_particles = [](SluiceRenderer* /*renderer*/, const SluiceParticles* particles,
                           SluiceError* /*error*/) -> SluiceResult {
        fake.last_colour = particles->colour != nullptr ? particles->colour[3 * particles->count - 1] : -1.0F;
        fake.last_fluid = particles->fluid != nullptr ? particles->fluid[particles->count - 1] : UINT32_MAX;
        return SLUICE_OK;
    };
    api.set_simulation = [](SluiceRenderer* /*renderer*/, const SluiceSimulation* simulation,
                            SluiceError* /*error*/) -> SluiceResult {
        if (simulation != nullptr) {
            eachArray(*simulation, simulation->velocity != nullptr,
                      [](const char* /*name*/, const auto* array, std::size_t elements, std::size_t /*most*/) {
                          if (elements > 0) {
                              float last = 0.0F;
                              std::memcpy(&last, reinterpret_cast<const char*>(array + elements) - sizeof last,
                                          sizeof last);
                              fake.words.push_back(last);
                          }
                      });
        }
        fake.last_solid = simulation != nullptr ? simulation->solids[simulation->solid_count - 1].radius : -1.0F;
        fake.last_velocity = simulation != nullptr && simulation->velocity != nullptr
                                 ? simulation->velocity[3 * simulation->particle_count - 1]
                                 : -1.0F;
        return SLUICE_OK;
    };
    api.simulate = [](SluiceRenderer* /*renderer*/, std::uint64_t value, double seconds,
                      SluiceError* /*error*/) -> SluiceResult {
        fake.simulated = static_cast<double>(value) + seconds;
        return SLUICE_OK;
    };
    api.simulation_stats = [](SluiceRenderer* /*renderer*/, SluiceSimulationStats* stats) -> SluiceResult {
        stats->reached = 12;
        return SLUICE_OK;
    };
    api.simulation_bodies = [](SluiceRenderer* /*renderer*/, std::uint64_t value,
                               SluiceBodies* bodies) -> SluiceResult {
        bodies->count = 2;
        bodies->value = value;
        return SLUICE_OK;
    };
    api.set_body = [](SluiceRenderer* /*renderer*/, std::uint32_t body, const SluiceBodyTarget* target,
                      SluiceError* /*error*/) -> SluiceResult {
        fake.simulated = static_cast<double>(body) + double{target->centre[1]};
        return SLUICE_OK;
    };
    api.set_flow = [](SluiceRenderer* /*renderer*/, const SluiceFlow* flow, SluiceError* /*error*/) -> SluiceResult {
        fake.simulated = double{flow->emitters[0].speed};
        return SLUICE_OK;
    };
    api.reset_simulation = [](SluiceRenderer* /*renderer*/, const SluiceStart* start,
                              SluiceError* /*error*/) -> SluiceResult {
        fake.last_velocity = start->velocity != nullptr ? start->velocity[3 * start->particle_count - 1] : -1.0F;
        fake.simulated = start->position != nullptr ? double{start->position[0]} : 0.0;
        fake.last_fluid =
            start->particle_fluids != nullptr ? start->particle_fluids[start->particle_count - 1] : UINT32_MAX;
        return SLUICE_OK;
    };
    api.submit_frame = [](SluiceRenderer* /*renderer*/, const SluiceFrame* frame,
                          SluiceError* /*error*/) -> SluiceResult {
        fake.own_value = frame->signal_value;
        return SLUICE_OK;
    };
    api.timeline_signal = [](SluiceRenderer* /*renderer*/, std::uint64_t value) -> SluiceResult {
        fake.signals += 1;
        fake.host_value = value;
        return SLUICE_OK;
    };
    api.timeline_wait = [](SluiceRenderer* /*renderer*/, std::uint64_t value,
                           std::uint64_t /*timeout_ns*/) -> SluiceResult {
        return fake.own_value >= value ? SLUICE_OK : SLUICE_TIMEOUT;
    };
    api.timeline_value = [](SluiceRenderer* /*renderer*/, std::uint32_t /*direction*/,
                            std::uint64_t* value) -> SluiceResult {
        *value = fake.own_value;
        return SLUICE_OK;
    };
    api.destroy = [](SluiceRenderer* renderer) { fake.destroyed += renderer != nullptr ? 1 : 0; };
    return api;
}

class IsolateServer : public ::testing::Test {
  protected:
    void SetUp() override {
        fake.host_value = fake.own_value = 0;
        fake.signals = 0;
        fake.destroyed = 0;
        auto ends = Channel::pair();
        ASSERT_TRUE(ends);
        host_ = std::move(ends.value().first);
        renderer_ = std::move(ends.value().second);
        timeline_ = SharedTimeline::create().value();
        server_ = std::thread([this] { served_ = serve(api_, renderer_); });
    }
    void TearDown() override { (void)end(); }
    Status end() {
        host_ = Channel();
        if (server_.joinable()) {
            server_.join();
        }
        return served_;
    }
    void send(const Message& message, std::initializer_list<int> fds = {}) {
        ASSERT_TRUE(host_.send(message, 3, {fds.begin(), fds.size()}, kLongNs));
    }
    Returned returned() {
        Result<Received> received = host_.receive(kLongNs);
        EXPECT_TRUE(received) << received.error().message();
        const auto* answer = received ? std::get_if<Returned>(&received.value().message) : nullptr;
        EXPECT_NE(answer, nullptr);
        return answer != nullptr ? *answer : Returned{};
    }
    void greet() {
        send(Hello{}, {timeline_->fd()});
        const Result<Received> received = host_.receive(kLongNs);
        ASSERT_TRUE(received);
        EXPECT_EQ(std::get<Welcome>(received.value().message).name, "fake");
    }
    void createRenderer(const Answer& answer) {
        send(Create{});
        const Result<Received> asked = host_.receive(kLongNs);
        ASSERT_TRUE(asked && std::holds_alternative<ShareImage>(asked.value().message));
        EXPECT_EQ(asked.value().fds.size(), 1U);
        send(answer);
    }

    SluiceRendererApi api_ = fakeApi();
    Channel host_, renderer_;
    std::unique_ptr<SharedTimeline> timeline_;
    std::thread server_;
    Status served_;
};

TEST_F(IsolateServer, CarriesCallsCallbacksMemoryAndCounters) {
    greet();
    createRenderer(Answer{});
    EXPECT_EQ(returned().result, SLUICE_OK);
    const std::array<float, 6> two{1, 2, 3, 4, 5, 6};
    const auto bytes = std::as_bytes(std::span(two));
    const std::array<std::uint32_t, 2> numbers{7, 3};
    const UniqueFd memory = sealedCopy({bytes, bytes}).value();
    send(SetParticles{{}, 2, 0.1F, 0, 1}, {memory.get()});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.last_colour, 6.0F);
    EXPECT_EQ(fake.last_fluid, UINT32_MAX);
    const UniqueFd mixed = sealedCopy({bytes, bytes, std::as_bytes(std::span(numbers))}).value();
    send(SetParticles{{}, 2, 0.1F, 0, 1, 1}, {mixed.get()});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.last_colour, 6.0F);
    EXPECT_EQ(fake.last_fluid, 3U);

    ASSERT_TRUE(timeline_->publish(SLUICE_HOST_TO_RENDERER, 1));
    SubmitFrame frame;
    frame.frame.frame = frame.frame.wait_value = frame.frame.signal_value = 1;
    send(frame);
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(timeline_->wait(SLUICE_RENDERER_TO_HOST, 1, kLongNs), WaitEnd::Reached);
    ASSERT_TRUE(timeline_->publish(SLUICE_HOST_TO_RENDERER, 4));
    send(Destroy{});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.host_value, 4U);
    EXPECT_EQ(fake.signals, 4U) << "value by value";
    EXPECT_TRUE(end());
    EXPECT_EQ(fake.destroyed, 1);
}

TEST_F(IsolateServer, ASimulationCrossesWithItsArraysOrIsRefused) {
    greet();
    createRenderer(Answer{});
    EXPECT_EQ(returned().result, SLUICE_OK);
    SluiceSolid solid{};
    solid.radius = 7.0F;
    const std::array<float, 6> two{1, 2, 3, 4, 5, 6};
    const UniqueFd memory =
        sealedCopy({std::as_bytes(std::span(&solid, 1)), std::as_bytes(std::span(two)), std::as_bytes(std::span(two))})
            .value();
    SetSimulation call{{}, 1, sized<SluiceSimulation>()};
    call.simulation.solid_count = 1;
    call.simulation.particle_count = 2;
    send(call, {memory.get()});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.last_solid, 7.0F);
    EXPECT_EQ(fake.last_velocity, 6.0F);
    send(Simulate{{}, 2, 0.5});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.simulated, 2.5);
    send(SimulationStats{});
    EXPECT_EQ(std::get<SluiceSimulationStats>(returned().filled).reached, 12U);
    send(SimulationBodies{{}, 9});
    EXPECT_EQ(std::get<SluiceBodies>(returned().filled).value, 9U);
    SetBody to{{}, 1, sized<SluiceBodyTarget>()};
    to.target.centre[1] = 0.25F;
    send(to);
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.simulated, 1.25);
    SetFlow flow{{}, sized<SluiceFlow>()};
    flow.flow.emitters[0].speed = 3.5F;
    send(flow);
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.simulated, 3.5);
    const std::array<float, 6> others{7, 2, 3, 4, 5, 8};
    const UniqueFd start = sealedCopy({std::as_bytes(std::span(two)), std::as_bytes(std::span(others))}).value();
    ResetSimulation reset{{}, 1, 0, sized<SluiceStart>()};
    reset.start.particle_count = 2;
    send(reset, {start.get()});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.simulated, 1.0);
    EXPECT_EQ(fake.last_velocity, 8.0F);
    EXPECT_EQ(fake.last_fluid, UINT32_MAX);
    const std::array<std::uint32_t, 2> fluids{1, 4};
    const UniqueFd mixed = sealedCopy({std::as_bytes(std::span(two)), std::as_bytes(std::span(fluids))}).value();
    ResetSimulation of_several{{}, 0, 1, reset.start};
    send(of_several, {mixed.get()});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.last_velocity, -1.0F);
    EXPECT_EQ(fake.last_fluid, 4U);
    reset.start.particle_count = 3;
    send(reset, {start.get()});
    EXPECT_EQ(returned().result, SLUICE_ERROR_INVALID_ARGUMENT) << "the memory is shorter than that";
    reset.start.particle_count = 0;
    send(reset);
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.simulated, 0.0) << "none, and no address";
    call.simulation.particle_count = 3;
    send(call, {memory.get()});
    EXPECT_EQ(returned().result, SLUICE_ERROR_INVALID_ARGUMENT) << "the memory is shorter than that";
    send(SetSimulation{{}, 0, sized<SluiceSimulation>()});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.last_solid, -1.0F);
}

TEST_F(IsolateServer, EveryArrayOfASimulationComesToItsOwnPlaceAndAnOlderPluginRefusesItByName) {
    greet();
    createRenderer(Answer{});
    EXPECT_EQ(returned().result, SLUICE_OK);
    auto s = sized<SluiceSimulation>();
    s.solid_count = s.particle_count = s.emitter_count = s.drain_count = s.field_count = s.body_count = 1;
    s.path_point_count = s.mesh_count = s.mesh_corner_count = s.mesh_triangle_count = 1;
    s.fluid_count = s.particle_fluid_count = 1;
    // Each array is full of words that say which it is.
    std::vector<std::vector<float>> arrays;
    std::vector<std::span<const std::byte>> parts;
    eachArray(s, true, [&](const char* /*name*/, const auto* array, std::size_t elements, std::size_t /*most*/) {
        arrays.emplace_back(elements * sizeof(*array) / sizeof(float), static_cast<float>(arrays.size()));
    });
    for (const std::vector<float>& array : arrays) {
        parts.push_back(std::as_bytes(std::span(array)));
    }
    const UniqueFd memory = sealedCopy(parts).value();
    fake.words.clear();
    send(SetSimulation{{}, 1, s}, {memory.get()});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_EQ(fake.words, (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));

    const std::uint32_t version = std::exchange(api_.abi_version, SLUICE_MAKE_ABI(1U, 2U));  // the server's table
    send(SetSimulation{{}, 1, s}, {memory.get()});
    EXPECT_THAT(returned().message, HasSubstr("simulation.fluids: the plugin serves ABI 1.2, and that came with 1.3"));
    SetFlow flow{{}, sized<SluiceFlow>()};
    flow.flow.fluid_count = 1;
    send(flow);
    EXPECT_THAT(returned().message, HasSubstr("flow.fluids"));
    api_.abi_version = version;

    api_.simulation_bodies = nullptr;
    send(SetSimulation{{}, 1, s}, {memory.get()});
    EXPECT_THAT(returned().message, HasSubstr("simulation.emitters"));
    send(SimulationBodies{{}, 1});
    EXPECT_EQ(returned().result, SLUICE_ERROR_UNSUPPORTED);
    api_.reset_simulation = nullptr;
    send(ResetSimulation{{}, 0, 0, sized<SluiceStart>()});
    EXPECT_THAT(returned().message, HasSubstr("does not know reset_simulation"));
}

TEST_F(IsolateServer, ARefusedImageIsTheRenderersFailure) {
    greet();
    createRenderer(Answer{{}, SLUICE_ERROR_IMPORT, "no room"});
    const Returned failed = returned();
    EXPECT_EQ(failed.result, SLUICE_ERROR_IMPORT);
    EXPECT_EQ(failed.message, "no room");
}

TEST_F(IsolateServer, ParticlesInLooseOrShortMemoryAreRefusedAndTheNextCallIsServed) {
    greet();
    createRenderer(Answer{});
    EXPECT_EQ(returned().result, SLUICE_OK);
    const UniqueFd loose(::memfd_create("loose", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    ASSERT_EQ(::ftruncate(loose.get(), 24), 0);
    send(SetParticles{{}, 2, 0.1F, 0, 0}, {loose.get()});
    EXPECT_EQ(returned().result, SLUICE_ERROR_INVALID_ARGUMENT);
    const std::array<float, 3> one{};
    const UniqueFd little = sealedCopy({std::as_bytes(std::span(one))}).value();
    send(SetParticles{{}, 0x4000'0000, 0.1F, 1, 1}, {little.get()});
    EXPECT_THAT(returned().message, HasSubstr("found 12"));
    send(SetEnvironment{{}, 0xFFFF'FFFF, 0xFFFF'FFFF}, {little.get()});
    EXPECT_EQ(returned().result, SLUICE_ERROR_INVALID_ARGUMENT);
    send(Info{});
    EXPECT_EQ(returned().result, SLUICE_OK);
    EXPECT_TRUE(end());
    EXPECT_EQ(fake.destroyed, 1) << "a host that vanishes leaves no renderer behind";
}

TEST_F(IsolateServer, AHostThatLeapsIsTold) {
    greet();
    createRenderer(Answer{});
    EXPECT_EQ(returned().result, SLUICE_OK);
    ASSERT_TRUE(timeline_->publish(SLUICE_HOST_TO_RENDERER, 1ULL << 40U));
    EXPECT_EQ(timeline_->wait(SLUICE_RENDERER_TO_HOST, 1, kLongNs), WaitEnd::Failed);
    EXPECT_EQ(timeline_->failure(), SLUICE_ERROR_INVALID_ARGUMENT);
}

TEST_F(IsolateServer, AnythingBeforeHelloEndsTheService) {
    send(Info{});
    server_.join();
    EXPECT_THAT(served_.error().message(), HasSubstr("its first message is no hello"));
}

TEST_F(IsolateServer, WhatIsNoCallEndsTheService) {
    greet();
    send(Line{{}, "x"});
    server_.join();
    EXPECT_THAT(served_.error().message(), HasSubstr("it sent a line where a call was expected"));
}

TEST_F(IsolateServer, AnotherMessageInPlaceOfAnAnswerEndsTheService) {
    greet();
    send(Create{});
    ASSERT_TRUE(host_.receive(kLongNs));
    send(Info{});
    server_.join();
    EXPECT_THAT(served_.error().message(), HasSubstr("it did not answer a share_image"));
}

TEST_F(IsolateServer, MemoryThatIsNoTimelineEndsTheService) {
    const UniqueFd null(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    send(Hello{}, {null.get()});
    server_.join();
    EXPECT_THAT(served_.error().message(), HasSubstr("shared memory: expected"));
}

TEST(FlowAfter, KeepsTheFluidsThatAnEarlierFlowChangedAndNoMoreThanThat) {
    auto thick = sized<SluiceFlow>();
    thick.fluid_count = 2;
    thick.fluids[1].viscosity = 0.5F;
    thick.iterations = 3;
    auto light = sized<SluiceFlow>();
    light.iterations = 4;
    EXPECT_EQ(flowAfter(std::nullopt, light).fluid_count, 0U);
    const SluiceFlow after = flowAfter(thick, light);
    EXPECT_EQ(after.fluid_count, 2U);
    EXPECT_EQ(after.fluids[1].viscosity, 0.5F);
    EXPECT_EQ(after.iterations, 4U);
    EXPECT_EQ(flowAfter(light, thick).fluids[1].viscosity, 0.5F);
}

}  // namespace
}  // namespace sluice::isolate
