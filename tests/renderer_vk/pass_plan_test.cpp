// SPDX-License-Identifier: MIT
// The plan's promises, over random needs.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pass_rig.hpp"
#include "plan/plan.hpp"

namespace sluice::vk {
namespace {

SluiceSceneNeeds anyNeeds() {
    SluiceSceneNeeds needs{};
    needs.struct_size = sizeof needs;
    needs.width = *rc::gen::inRange(1U, 4097U);
    needs.height = *rc::gen::inRange(1U, 4097U);
    needs.particle_count = *rc::gen::element(0U, 1U, 100000U);
    needs.has_environment_map = *rc::gen::inRange(0U, 2U);
    needs.outputs = *rc::gen::inRange(0U, 1U << SLUICE_IMAGE_ROLE_COUNT);
    needs.fluid = test::kWater;
    const auto onOff = [](float value) { return *rc::gen::element(0.0F, value); };
    for (float& value : needs.fluid.absorption) {
        value = onOff(1.0F);
    }
    for (float& value : needs.fluid.scatter_colour) {
        value = onOff(0.1F);
    }
    needs.fluid.filter = *rc::gen::inRange(0U, 2U);
    needs.fluid.filter_iterations = *rc::gen::inRange(0U, 5U);
    needs.fluid.filter_sigma = onOff(1.0F);
    needs.fluid.thickness_scale = *rc::gen::element(1.0F, 0.5F, 0.25F);
    needs.fluid.thickness_blur = onOff(1.0F);
    needs.fluid.refraction = *rc::gen::inRange(0U, 2U);
    needs.fluid.reflection = *rc::gen::inRange(0U, 2U);
    needs.fluid.view = *rc::gen::inRange(0U, 5U);
    needs.other_look_count = *rc::gen::element(0U, 1U, 7U);
    return needs;
}

Plan planOf(const SluiceSceneNeeds& needs) {
    auto plan = makePlan(needs);
    RC_ASSERT(plan.ok());
    return plan.value();
}

bool shared(PlanImage image) {
    return image >= PlanImage::HostColour;
}

bool tileList(PlanImage image) {
    return image == PlanImage::SurfaceTiles || image == PlanImage::ThicknessTiles;
}

std::set<PassId> passesOf(const Plan& plan) {
    std::set<PassId> ids;
    for (const PlannedPass& pass : plan.passes) {
        ids.insert(pass.id);
    }
    return ids;
}

RC_GTEST_PROP(PassPlan, NoPassReadsWhatNoEarlierPassWrote, ()) {
    std::set<PlanImage> written;
    for (const PlannedPass& pass : planOf(anyNeeds()).passes) {
        for (const PlanImage image : pass.reads) {
            RC_ASSERT((shared(image) && !tileList(image)) || written.contains(image));
        }
        written.insert(pass.writes.begin(), pass.writes.end());
    }
    RC_ASSERT(written.contains(PlanImage::FluidColour) && written.contains(PlanImage::FluidDepth));
}

RC_GTEST_PROP(PassPlan, EveryImageIsWrittenAndReadAndEveryUsedImageIsAllocated, ()) {
    const Plan plan = planOf(anyNeeds());
    std::set<PlanImage> read;
    std::set<PlanImage> written;
    for (const PlannedPass& pass : plan.passes) {
        read.insert(pass.reads.begin(), pass.reads.end());
        written.insert(pass.writes.begin(), pass.writes.end());
    }
    // Sums of the blur and the reduced scene are read by the same pass that writes them.
    read.insert({PlanImage::ThicknessSums, PlanImage::OpticalSums, PlanImage::SceneDepth});
    for (const PlannedImage& image : plan.images) {
        RC_ASSERT(read.contains(image.id) && written.contains(image.id));
        RC_ASSERT(image.width > 0 && image.height > 0 && !shared(image.id));
    }
    for (const PlanImage image : written) {
        RC_ASSERT(!tileList(image) || read.contains(image));
        RC_ASSERT(shared(image) || findImage(plan, image) != nullptr);
    }
}

RC_GTEST_PROP(PassPlan, EveryPassIsEitherKeptOrLeftOutAndSaysWhy, ()) {
    const Plan plan = planOf(anyNeeds());
    RC_ASSERT(plan.passes.size() + plan.omitted.size() == static_cast<std::size_t>(PassId::Count));
    std::set<PassId> seen = passesOf(plan);
    for (const OmittedPass& pass : plan.omitted) {
        RC_ASSERT(seen.insert(pass.id).second);
        RC_ASSERT(!pass.reason.empty());
    }
    const auto sorted = [](const PlannedPass& a, const PlannedPass& b) { return a.id < b.id; };
    RC_ASSERT(std::is_sorted(plan.passes.begin(), plan.passes.end(), sorted));
    RC_ASSERT(explain(plan).size() == static_cast<std::size_t>(PassId::Count) + plan.images.size());
}

RC_GTEST_PROP(PassPlan, IsDeterministic, ()) {
    const SluiceSceneNeeds needs = anyNeeds();
    RC_ASSERT(planOf(needs) == planOf(needs));
    RC_ASSERT(explain(planOf(needs)) == explain(planOf(needs)));
}

RC_GTEST_PROP(PassPlan, AskingForMoreNeverRemovesAPass, ()) {
    SluiceSceneNeeds less = anyNeeds();
    RC_PRE(less.particle_count > 0 && less.fluid.view != SLUICE_VIEW_ECHO);
    SluiceSceneNeeds more = less;
    more.outputs |= SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS);
    more.fluid.absorption[0] = 1.0F;
    more.fluid.refraction = more.fluid.reflection = 1;
    more.fluid.thickness_blur = 1.0F;
    const auto few = passesOf(planOf(less));
    const auto many = passesOf(planOf(more));
    RC_ASSERT(std::includes(many.begin(), many.end(), few.begin(), few.end()));
}

RC_GTEST_PROP(PassPlan, WhatIsNotNeededIsNotBound, ()) {
    SluiceSceneNeeds needs = anyNeeds();
    needs.fluid.refraction = 0;
    for (const PlannedPass& pass : planOf(needs).passes) {
        RC_ASSERT(pass.id == PassId::Echo || std::ranges::count(pass.reads, PlanImage::HostColour) == 0);
    }
}

TEST(PassPlan, EchoIsOnlyEcho) {
    SluiceSceneNeeds needs{};
    needs.width = 64;
    needs.height = 48;
    needs.fluid.view = SLUICE_VIEW_ECHO;
    const auto plan = makePlan(needs);
    ASSERT_TRUE(plan.ok());
    ASSERT_EQ(plan.value().passes.size(), 1U);
    EXPECT_EQ(plan.value().passes[0].id, PassId::Echo);
    EXPECT_TRUE(plan.value().images.empty());
}

TEST(PassPlan, AClearUnabsorbingUnrefractingFluidHasNoThickness) {
    SluiceSceneNeeds needs{};
    needs.width = 64;
    needs.height = 48;
    needs.particle_count = 1;
    needs.fluid = test::kWater;
    needs.fluid.refraction = 0;
    std::fill_n(needs.fluid.absorption, 3, 0.0F);
    std::fill_n(needs.fluid.scatter_colour, 3, 0.0F);
    const auto plan = makePlan(needs);
    ASSERT_TRUE(plan.ok());
    EXPECT_EQ(findPass(plan.value(), PassId::SplatThickness), nullptr);
    EXPECT_EQ(findPass(plan.value(), PassId::BlurThickness), nullptr);
    EXPECT_EQ(findImage(plan.value(), PlanImage::Thickness), nullptr);
}

RC_GTEST_PROP(PassPlan, SeveralLooksCostOpticalDepthAndOneLookNothing, ()) {
    SluiceSceneNeeds needs = anyNeeds();
    RC_PRE(needs.particle_count > 0);
    needs.other_look_count = 0;
    const Plan one = planOf(needs);
    needs.other_look_count = 2;
    const Plan several = planOf(needs);
    RC_ASSERT(findImage(one, PlanImage::OpticalDepth) == nullptr && !one.several_looks);
    const bool shaded = needs.fluid.view == SLUICE_VIEW_FLUID;
    RC_ASSERT((findImage(several, PlanImage::OpticalDepth) != nullptr) == shaded);
    RC_ASSERT(shaded || several == one);
}

TEST(PassPlan, RefusesNumbersOutOfRangeAndNamesThem) {
    SluiceSceneNeeds good{};
    good.width = 64;
    good.height = 48;
    good.particle_count = 1;
    good.fluid = test::kWater;
    ASSERT_TRUE(makePlan(good).ok());
    const auto refused = [&](auto change, const char* field) {
        SluiceSceneNeeds bad = good;
        change(bad);
        const auto plan = makePlan(bad);
        EXPECT_FALSE(plan.ok()) << field;
        if (!plan.ok()) {
            EXPECT_EQ(plan.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
            EXPECT_NE(plan.error().message().find(field), std::string::npos) << plan.error().message();
        }
    };
    refused([](auto& n) { n.width = 0; }, "width");
    refused([](auto& n) { n.height = 16385; }, "height");
    refused([](auto& n) { n.fluid.splat_radius = std::nanf(""); }, "splat_radius");
    refused([](auto& n) { n.fluid.index_of_refraction = 0.9F; }, "index_of_refraction");
    refused([](auto& n) { n.fluid.absorption[1] = -1.0F; }, "absorption[1]");
    refused([](auto& n) { n.fluid.thickness_scale = 0.3F; }, "thickness_scale");
    refused([](auto& n) { n.fluid.foam = std::nanf(""); }, "fluid.foam");
    refused([](auto& n) { n.fluid.filter_max_pixels = kMaxFilterPixels + 1; }, "filter_max_pixels");
    refused([](auto& n) { n.fluid.filter_iterations = kMaxFilterIterations + 1; }, "filter_iterations");
    refused([](auto& n) { n.fluid.filter = 7; }, "filter");
    refused([](auto& n) { n.fluid.view = 9; }, "view");
    refused([](auto& n) { n.other_look_count = 8; }, "other_look_count");
}

}  // namespace
}  // namespace sluice::vk
