// SPDX-License-Identifier: MIT
// Memory that runs out at each allocation of Sluice's own code in turn, on the host's thread: an error or a frame,
// nothing left behind (LeakSanitizer sees to the memory), and fluid again when there is memory again.
//
// There are hundreds of allocations in a start. Each case tries some spread over all of them; with the environment
// variable SLUICE_EVERY_ALLOCATION set, every one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "allocation_fault.hpp"
#include "gl_test.hpp"
#include "recovery_rig.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::host::test {
namespace {

constexpr std::uint64_t kSome = 12;

class OutOfMemory : public RecoveryTest {
  protected:
    /// `before` and `after` with memory, `body` without: called for a spread of all its allocations.
    void atEachAllocationOf(const std::function<void()>& before, const std::function<void()>& body,
                            const std::function<void()>& after) {
        std::uint64_t all = 0;
        before();
        {
            const FailingAllocation none(0);
            body();
            all = none.counted();
        }
        after();
        ASSERT_GT(all, 0U);
        RecordProperty("allocations", static_cast<int>(all));
        const std::uint64_t step =
            std::getenv("SLUICE_EVERY_ALLOCATION") != nullptr ? 1 : std::max<std::uint64_t>(all / kSome, 1);
        std::uint64_t failed = 0;
        for (std::uint64_t nth = 1; nth <= all; nth += step) {
            SCOPED_TRACE(nth);
            before();
            {
                const FailingAllocation scarce(nth);
                body();
                failed += scarce.failed() ? 1U : 0U;
            }
            after();
        }
        // Threads and caches make one more or less of them now and then.
        EXPECT_GE(failed * 2, all / step) << "the memory never ran out";
        complaints_.clear();
    }
    void beginSmall() {
        FluidHostConfig wanted = recovering(SLUICE_TIMELINE_FINISH);
        wanted.image_sets = 1;
        wanted.width = 32;
        wanted.height = 16;
        wanted.recovery.settled_frames = 1;
        ASSERT_NO_FATAL_FAILURE(makeHost(wanted));
        ASSERT_NO_FATAL_FAILURE(makeScreen(32, 16));
    }
    /// Fluid comes back within the two tries that a fault of a fault needs.
    void recovers() {
        drawn_ += 100;  // stamps that were not seen before
        EXPECT_THAT(run(6), ::testing::EndsWith("ff"));
    }
};

TEST_F(OutOfMemory, InAStart) {
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_FINISH);
    wanted.image_sets = 1;
    wanted.width = 32;
    wanted.height = 16;
    std::optional<Result<std::unique_ptr<FluidHost>>> made;
    int descriptors = -1;
    atEachAllocationOf([] {}, [&] { made.emplace(FluidHost::create(*library_, wanted)); },
                       [&] {
                           if (!made->ok()) {
                               EXPECT_FALSE(made->error().message().empty());
                           }
                           made.reset();
                           descriptors = descriptors < 0 ? openDescriptors() : descriptors;
                           EXPECT_TRUE(descriptorsReturnTo(descriptors))
                               << openDescriptors() << " instead of " << descriptors;
                       });
    ASSERT_NO_FATAL_FAILURE(beginSmall());
    EXPECT_EQ(run(2), "ff");
}

TEST_F(OutOfMemory, InAFrame) {
    ASSERT_NO_FATAL_FAILURE(beginSmall());
    EXPECT_EQ(run(2), "ff");
    const FrameInput input = echoInput();
    Status status;
    atEachAllocationOf([&] { drawStamp(*screen_, 1, 1); },
                       [&] {
                           status = host_->submit(*screen_, input);
                           if (status) {
                               status = host_->composite(*screen_);
                           }
                           (void)host_->stats(host_->frame());
                       },
                       [&] { recovers(); });
}

TEST_F(OutOfMemory, InAResizeAndANewScene) {
    ASSERT_NO_FATAL_FAILURE(beginSmall());
    std::vector<float> positions(300, 0.0F);
    auto particles = sized<SluiceParticles>();
    particles.count = 100;
    particles.radius = 0.5F;
    particles.position = positions.data();
    atEachAllocationOf([] {},
                       [&] {
                           (void)host_->resize(32, 16);
                           (void)host_->setParticles(particles);
                           (void)host_->setEnvironment(nullptr);
                       },
                       [&] { recovers(); });
}

TEST_F(OutOfMemory, AnEndNeedsNone) {
    ASSERT_NO_FATAL_FAILURE(beginSmall());
    EXPECT_EQ(run(2), "ff");
    const FailingAllocation none(0);
    host_.reset();
    EXPECT_EQ(none.counted(), 0U);
}

}  // namespace
}  // namespace sluice::host::test
