// SPDX-License-Identifier: MIT
// What a stress run will do follows from its options and its seed, and from nothing else.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "stress/plan.hpp"

namespace sluice::stress::test {
namespace {

std::vector<Combination> everything() {
    Options options;
    options.fault.reset();
    return matrixOf(options).value().runs;
}

std::vector<Epoch> epochsOf(const Combination& one, std::uint64_t seed, int count) {
    Planner planner(one, seed);
    std::vector<Epoch> epochs;
    epochs.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        epochs.push_back(planner.next());
    }
    return epochs;
}

TEST(Matrix, HoldsEveryPatternResourceAndFault) {
    const auto all = everything();
    for (const auto& pattern : kPatterns) {
        for (const auto& resource : kResources) {
            for (const auto& fault : kFaults) {
                for (const auto& backend : kBackends) {
                    const bool found = std::any_of(all.begin(), all.end(), [&](const Combination& one) {
                        return one.pattern == pattern.value && one.resource == resource.value &&
                               one.fault == fault.value && one.backend == backend.value;
                    });
                    const bool layout = resource.value != Resource::Buffer || fault.value != Fault::WrongLayout;
                    EXPECT_EQ(found, layout && (backend.value != Backend::Finish ||
                                                pattern.value != Pattern::WaitBeforeSignal))
                        << pattern.name << ' ' << resource.name << ' ' << fault.name << ' ' << backend.name;
                }
            }
        }
    }
}

TEST(Matrix, IsCleanUnlessAFaultIsNamed) {
    const auto matrix = matrixOf(Options{});
    for (const Combination& one : matrix.value().runs) {
        EXPECT_EQ(one.fault, Fault::None);
    }
}

TEST(Matrix, RefusesWhatIsNotThereAndSaysWhy) {
    const auto why = [](const Options& options) {
        const auto matrix = matrixOf(options);
        return matrix ? std::string() : matrix.error().message();
    };
    Options options;
    options.backend = Backend::Finish;
    options.topology = Topology::TwoProcesses;
    EXPECT_NE(why(options).find("take bridged"), std::string::npos);
    options.topology = Topology::BridgeThread;
    EXPECT_NE(why(options).find("no bridge"), std::string::npos);
    options.topology.reset();
    options.pattern = Pattern::WaitBeforeSignal;
    EXPECT_FALSE(why(options).empty());
}

TEST(Matrix, OfPiglitsRunHasTheThreeKindsOfMemory) {
    Options options;
    options.pattern = Pattern::PingPong;
    options.backend = Backend::Bridged;
    options.topology = Topology::BridgeThread;
    options.alternations = true;
    std::vector<Resource> resources;
    const Matrix matrix = matrixOf(options).value();
    for (const Combination& one : matrix.runs) {
        resources.push_back(one.resource);
    }
    EXPECT_EQ(resources, (std::vector{Resource::Colour, Resource::D32F, Resource::Buffer}));
    EXPECT_EQ(kAlternations, 32'640U);
}

TEST(Plan, IsTheSameForTheSameSeedAndAnotherForAnother) {
    std::size_t same = 0;
    std::size_t chance = 0;
    for (const Combination& one : everything()) {
        EXPECT_EQ(epochsOf(one, 11, 20), epochsOf(one, 11, 20));
        EXPECT_EQ(Planner(one, 11).shape(), Planner(one, 11).shape());
        if (one.fault != Fault::None) {
            ++chance;
            same += epochsOf(one, 11, 20) == epochsOf(one, 12, 20) ? 1U : 0U;
        }
    }
    EXPECT_GT(chance, 0U);
    EXPECT_EQ(same, 0U);
}

TEST(Plan, MakesContextsAndDeviceAnewOftenEnoughToSeeALeak) {
    for (const Combination& one : everything()) {
        if (one.pattern != Pattern::CreateDestroyStorm || one.fault != Fault::None) {
            continue;
        }
        for (std::uint64_t seed = 1; seed <= 200; ++seed) {
            Planner planner(one, seed);
            int everything_anew = 0;
            // Two hand-offs per round; a share of the 20000 that are run when nothing is said is 142.
            for (std::uint64_t handoffs = 0; handoffs < 142;) {
                const Epoch epoch = planner.next();
                everything_anew += epoch.rebuild == Rebuild::Everything ? 1 : 0;
                handoffs += std::uint64_t{2} * epoch.rounds;
            }
            EXPECT_GE(everything_anew, 3) << "seed " << seed;
        }
    }
}

RC_GTEST_PROP(Plan, KeepsItsBounds, (std::uint64_t seed)) {
    const auto all = everything();
    const Combination one = all[*rc::gen::inRange<std::size_t>(0, all.size())];
    Planner planner(one, seed);
    const Shape shape = planner.shape();
    RC_ASSERT(shape.sets >= 1U && shape.sets <= kMaxSets && shape.fan >= 1U && shape.fan <= kMaxSets);
    for (int i = 0; i < 20; ++i) {
        const Epoch epoch = planner.next();
        RC_ASSERT(epoch.rounds > 0U && epoch.width > 0U && epoch.height > 0U);
        RC_ASSERT(i > 0 || (epoch.rebuild == Rebuild::Everything && epoch.fresh));
        RC_ASSERT(epoch.fault.kind == one.fault);
        if (one.fault != Fault::None) {
            RC_ASSERT(epoch.fault.round > shape.sets);
            RC_ASSERT(epoch.fault.round + 2 * shape.sets < epoch.rounds);
        }
        // To leave the queue's wait out is no fault where the order of submission already says as much.
        RC_ASSERT(epoch.fault.side == Side::Gl || one.topology != Topology::OneThread ||
                  one.fault == Fault::EarlyReuse || one.fault == Fault::WrongLayout);
    }
}

TEST(Plan, RepeatsWithTheCommandThatItPrints) {
    EXPECT_EQ(commandLine({Pattern::Ring, Backend::Finish, Resource::D32F, Topology::OneThread, Fault::Drop}, 7, 90),
              "sluice stress --pattern ring --backend finish --resource D32F --topology one-thread --fault drop "
              "--seed 7 --handoffs 90");
}

}  // namespace
}  // namespace sluice::stress::test
