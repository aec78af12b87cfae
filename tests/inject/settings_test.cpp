// SPDX-License-Identifier: MIT
// What the launcher says arrives in the payload.
#include "payload/settings.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace sluice::inject::test {
namespace {

TEST(InjectSettings, EverySettingComesBackAsItWasPrinted) {
    Settings settings;
    settings.children = true;
    settings.shim = "/opt/a folder/libsluice_inject.so";
    settings.off = settings.audit = settings.same_process = true;
    settings.report = "/tmp/x y";
    settings.step = 1.0 / 30.0;
    settings.plugin = "/p.so";
    settings.rules = {CameraRoute::Uniforms, OverlaySwitch::Never, ViewRule::Pushed, 0.1, 512.0};
    settings.water.in_view = false;
    settings.water.units_per_metre = 0.1F;
    settings.water.up = {0, 0, 1};
    settings.water.blocks = {{{1, 2, 3}, {4, 5, 6.125F}, {-0.1F, 0, 0}}};
    settings.water.emitters.push_back({SLUICE_OPENING_DISC, {0, 1, 0}, {0, -1, 0}, 0.3F, 0.3F, 2, 0, 0, 5, 0, {}});
    settings.water.max_particles = 5000;
    settings.water.from_frame = 60;
    SluiceFluid look{};
    look.index_of_refraction = 1.33F;
    look.filter_iterations = 3;
    settings.look = look;
    const Settings back = parseSettings(printSettings(settings));
    EXPECT_EQ(printSettings(back), printSettings(settings));
    EXPECT_EQ(back.shim, settings.shim);
    EXPECT_EQ(back.report, settings.report);
    EXPECT_EQ(back.step, settings.step);
    EXPECT_EQ(back.rules.far_plane, settings.rules.far_plane);
    ASSERT_EQ(back.water.blocks.size(), 1U);
    EXPECT_EQ(back.water.blocks[0].velocity[0], -0.1F);
    ASSERT_EQ(back.water.emitters.size(), 1U);
    EXPECT_EQ(back.water.emitters[0].width, 0.3F);
    ASSERT_TRUE(back.look);
    EXPECT_EQ(std::memcmp(&*back.look, &look, sizeof(look)), 0);
    EXPECT_FALSE(back.sky);
    EXPECT_TRUE(printSettings(settings).starts_with("children\nshim "));  // what the shim reads itself
}

TEST(InjectSettings, WhatIsNoSettingChangesNothing) {
    const Settings plain = parseSettings(printSettings({}));
    for (const char* text :
         {"", "\n\n", "route 99\n", "water.low 1 2\n", "look 1 2 3\n", "step abc\n", "nonsense 1\n"}) {
        EXPECT_EQ(printSettings(parseSettings(text)), printSettings(plain)) << text;
    }
}

}  // namespace
}  // namespace sluice::inject::test
