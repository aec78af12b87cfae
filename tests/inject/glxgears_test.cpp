// SPDX-License-Identifier: MIT
// The oldest program of them all, as Debian has it, on a screen: itself without fluid, wet with it.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "display.hpp"
#include "screen.hpp"

namespace sluice::inject::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kWidth = 120, kHeight = 90;
constexpr const char* kFrozen = "env LD_PRELOAD='" SLUICE_FROZEN_CLOCK "' ";
constexpr const char* kGears = "glxgears -geometry 120x90+0+0";

using Picture = std::vector<unsigned long>;

/// The largest of the three gears is there.
bool hasGears(const Picture& picture) {
    return std::count_if(picture.begin(), picture.end(),
                         [](unsigned long c) { return (c >> 16U) > 0x60U && (c & 0xFFFFU) < 0x2000U; }) > 200;
}

long differing(const Picture& a, const Picture& b) {
    long count = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        count += a[i] != b[i] ? 1 : 0;
    }
    return count;
}

class Glxgears : public InjectTest {
  protected:
    void SetUp() override {
        InjectTest::SetUp();
        if (std::system("command -v glxgears >/dev/null") != 0) {
            ASSERT_EQ(std::getenv("SLUICE_REQUIRE_X"), nullptr) << "install mesa-utils: there is no glxgears";
            GTEST_SKIP() << "NOT RUN: there is no glxgears (apt-get install mesa-utils)";
        }
        screen_ = std::make_unique<ScreenView>(server());
        ASSERT_TRUE(screen_->ok());
    }
    /// The screen while that runs, as soon as it is `right`, or after a long time.
    Picture whileRunning(const std::string& words, const std::function<bool(const Picture&)>& right, Outcome& outcome,
                         int width = kWidth, int height = kHeight) {
        Picture seen;
        outcome = runUntil(words, [&] {
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
            do {
                std::this_thread::sleep_for(std::chrono::milliseconds(30));
                seen = screen_->look(width, height);
            } while (!right(seen) && std::chrono::steady_clock::now() < end);
        });
        screen_->wipe();
        return seen;
    }

  private:
    std::unique_ptr<ScreenView> screen_;
};

TEST_F(Glxgears, IsItselfWithoutFluidAndWetWithIt) {
    Outcome bare;
    Picture before;
    const auto isWhole = [&](const Picture& seen) {  // and not looked at when it is half drawn
        return hasGears(seen) && seen == std::exchange(before, seen);
    };
    const Picture dry = whileRunning(std::string(kFrozen) + kGears, isWhole, bare);
    ASSERT_TRUE(hasGears(dry)) << bare.err;

    const std::string inject = std::string(kFrozen) + "'" SLUICE_PROGRAM "' inject --report ";
    Outcome off;
    long worst = 0;
    int looks = 0;
    const auto isDry = [&](const Picture& seen) {
        worst = hasGears(seen) ? std::max(worst, differing(seen, dry)) : worst;
        return hasGears(seen) && ++looks == 15;
    };
    EXPECT_TRUE(hasGears(whileRunning(inject + "--off -- " + kGears, isDry, off)));
    EXPECT_EQ(worst, 0);
    EXPECT_THAT(off.out, HasSubstr("by glXSwapBuffers")) << off.err;

    Outcome wet;
    // For longer than the report's interval: a program that is killed leaves the last report, which must know of the
    // water.
    std::optional<std::chrono::steady_clock::time_point> wet_since;
    const auto isWet = [&](const Picture& seen) {
        const auto now = std::chrono::steady_clock::now();
        if (!hasGears(seen) || differing(seen, dry) <= 500) {  // as where it is looked at when it is half drawn
            wet_since.reset();
            return false;
        }
        return now - wet_since.emplace(wet_since.value_or(now)) > std::chrono::milliseconds(1500);
    };
    const Picture last = whileRunning(inject + "--step 0.02 -- " + kGears, isWet, wet);
    EXPECT_TRUE(isWet(last)) << wet.err << wet.out;
    EXPECT_THAT(wet.out, HasSubstr("near 5, far 60; projection matrix; confidence 0.95"));
    EXPECT_THAT(wet.out, HasSubstr(", 0 without;")) << wet.err;
    EXPECT_THAT(wet.out, HasSubstr("compared before and after: no difference"));
    EXPECT_THAT(wet.err, IsEmpty());
}

TEST_F(Glxgears, OfOpenGlEsWithoutAnyOtherLibraryAreSeen) {
    int looks = 0;
    Outcome off;
    const auto enough = [&](const Picture& seen) { return hasGears(seen) && ++looks == 15; };
    const Picture seen =
        whileRunning("'" SLUICE_PROGRAM "' inject --off --report -- es2gears_x11", enough, off, 300, 300);
    EXPECT_TRUE(hasGears(seen)) << off.err;
    EXPECT_THAT(off.out, HasSubstr("context 1: EGL, OpenGL ES ")) << off.err;
}

}  // namespace
}  // namespace sluice::inject::test
