// SPDX-License-Identifier: MIT
// The engine's own physics: it hangs, moves, is the same again, and its state is the engine's own.
#include "engine/cloth.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "gl_test.hpp"
#include "sluice/host_gl/screen.hpp"

namespace sluice::host::test {
namespace {

constexpr Banner kBanner{{-0.5F, 2.0F, 0.0F}, {0.5F, 2.0F, 0.0F}, 0.8F, 12, 16};

TEST(Cloth, HangsFromItsLineMovesInTheWindAndIsTheSameAgain) {
    Cloth cloth(kBanner);
    const std::vector<Vec3> start = cloth.points();
    ASSERT_EQ(start.size(), 13U * 13U);
    Cloth again(kBanner);
    float most = 0.0F;
    for (int step = 0; step < 120; ++step) {
        cloth.step(1.0F / 60.0F);
        again.step(1.0F / 60.0F);
        most = std::max(most, cloth.stretch());
    }
    EXPECT_EQ(cloth.points(), again.points());
    EXPECT_LT(most, 1.5F) << "threads hold";
    for (std::size_t i = 0; i < start.size(); ++i) {
        const Vec3& now = cloth.points()[i];
        EXPECT_EQ(now == start[i], i <= 12U) << "only the pinned row stays where it is: " << i;
        EXPECT_TRUE(std::isfinite(now[0]) && std::abs(now[2]) < 1.0F && now[1] > 0.9F) << i;
    }
}

class BannerPicture : public GlTest {};

TEST_F(BannerPicture, ChangesWhenTheEngineIsAnimatedAndOnlyThen) {
    EngineScene scene;
    scene.banners.push_back(kBanner);
    auto screen = Screen::create(64, 48);
    auto engine = LegacyEngine::create(scene);
    ASSERT_TRUE(screen && engine);
    SluiceCamera camera{};
    for (const int diagonal : {0, 5, 10, 15}) {
        camera.view[diagonal] = camera.projection[diagonal] = 1.0F;
    }
    camera.view[13] = -1.6F;
    camera.view[14] = -2.0F;
    camera.projection[10] = -1.01F;
    camera.projection[11] = -1.0F;
    camera.projection[14] = -0.2F;
    camera.projection[15] = 0.0F;
    camera.near_plane = 0.1F;
    camera.far_plane = 20.0F;
    SluiceSky sky{};
    sky.to_sun[1] = 1.0F;
    sky.sun_radiance[0] = sky.zenith[2] = sky.horizon[1] = 1.0F;
    const auto picture = [&] {
        screen.value().bind();
        engine.value().draw(camera, sky);
        return readDepth(screen.value(), nullptr).values;
    };
    const auto before = picture();
    EXPECT_EQ(picture(), before);
    for (int step = 0; step < 30; ++step) {
        engine.value().animate(1.0F / 30.0F);
    }
    EXPECT_NE(picture(), before);
    scene.banners.front().cells = 0;
    EXPECT_FALSE(LegacyEngine::create(scene));
}

}  // namespace
}  // namespace sluice::host::test
