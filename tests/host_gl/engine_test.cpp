// SPDX-License-Identifier: MIT
#include "sluice/host_gl/engine.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <numbers>

#include "engine/colour.hpp"
#include "engine/sky_dome.hpp"
#include "gl_test.hpp"
#include "sluice/host_gl/screen.hpp"
#include "sluice/host_gl/state_snapshot.hpp"

namespace sluice::host::test {
namespace {

using Engine = GlTest;

constexpr std::uint32_t kWidth = 320;
constexpr std::uint32_t kHeight = 180;
constexpr float kNear = 0.1F;
constexpr float kFar = 60.0F;

EngineScene courtyard() {
    EngineScene scene;
    scene.basins.push_back({{0.0F, 0.0F, 0.0F}, 1.05F, 1.05F, 0.85F, 0.18F});
    scene.pillars.push_back({{-1.9F, 0.0F, -0.35F}, 0.16F, 2.6F});
    scene.crates.push_back({{1.2F, 0.35F, 2.3F}, 0.7F, 24.0F});
    return scene;
}

SluiceSky noon() {
    const glm::vec3 to_sun = glm::normalize(glm::vec3(-0.55F, 0.75F, 0.45F));
    return {{0.16F, 0.36F, 0.78F},          {0.72F, 0.80F, 0.88F}, {0.35F, 0.31F, 0.26F},
            {to_sun.x, to_sun.y, to_sun.z}, {20.0F, 18.0F, 15.0F}, {}};
}

struct View {
    glm::vec3 eye, target;
};

SluiceCamera cameraOf(const View& view) {
    SluiceCamera camera{};
    const glm::mat4 look = glm::lookAt(view.eye, view.target, glm::vec3(0.0F, 1.0F, 0.0F));
    const glm::mat4 lens =
        glm::perspective(glm::radians(58.3F), static_cast<float>(kWidth) / static_cast<float>(kHeight), kNear, kFar);
    std::copy_n(glm::value_ptr(look), 16, &camera.view[0]);
    std::copy_n(glm::value_ptr(lens), 16, &camera.projection[0]);
    camera.near_plane = kNear;
    camera.far_plane = kFar;
    return camera;
}

/// The unit direction through the centre of pixel (x, y), y from the top; double precision.
glm::dvec3 rayThrough(const View& view, std::uint32_t x, std::uint32_t y) {
    const SluiceCamera camera = cameraOf(view);
    const glm::dmat4 look(glm::make_mat4(&camera.view[0]));
    const glm::dmat4 lens(glm::make_mat4(&camera.projection[0]));
    const glm::dvec4 clip((x + 0.5) / kWidth * 2.0 - 1.0, 1.0 - (y + 0.5) / kHeight * 2.0, 1.0, 1.0);
    const glm::dvec4 eye = glm::inverse(lens) * clip;
    return glm::normalize(glm::inverse(glm::dmat3(look)) * glm::dvec3(eye));
}

/// Metres along the ray, from window depth.
double metres(const View& view, std::uint32_t x, std::uint32_t y, float depth) {
    const double z = 2.0 * double{depth} - 1.0;
    const double along_axis =
        2.0 * double{kNear} * double{kFar} / (double{kFar} + double{kNear} - z * (double{kFar} - double{kNear}));
    const glm::dvec3 axis = glm::normalize(glm::dvec3(view.target) - glm::dvec3(view.eye));
    return along_axis / glm::dot(rayThrough(view, x, y), axis);
}

struct Frame {
    Pixels colour, depth;
};

Frame render(const EngineScene& scene, const View& view, const SluiceSky& sky) {
    auto screen = Screen::create(kWidth, kHeight);
    auto engine = LegacyEngine::create(scene);
    EXPECT_TRUE(screen.ok() && engine.ok());
    screen.value().bind();
    engine.value().draw(cameraOf(view), sky);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    return {readColour(screen.value(), nullptr), readDepth(screen.value(), nullptr)};
}

float valueAt(const Pixels& pixels, std::uint32_t x, std::uint32_t y, std::uint32_t channel = 0) {
    return pixels.values.at((std::size_t{y} * pixels.width + x) * pixels.channels + channel);
}

/// Half a step of the 24-bit buffer at this distance, twice over, and the float rounding of the transform.
double depthBound(double distance) {
    return distance * distance / double{kNear} / 16777215.0 + 1e-4 * distance;
}

TEST_F(Engine, FloorDepthIsThatOfThePlane) {
    EngineScene scene;
    scene.floor_height = 0.25F;
    const View view{{-4.0F, 4.0F, -3.0F}, {0.0F, 0.4F, 0.0F}};
    const Frame frame = render(scene, view, noon());
    int compared = 0;
    for (std::uint32_t y = kHeight / 3; y < kHeight; y += 7) {
        for (std::uint32_t x = 3; x < kWidth; x += 11) {
            const glm::dvec3 ray = rayThrough(view, x, y);
            const double expected = (0.25 - 4.0) / ray.y;
            const glm::dvec3 hit = glm::dvec3(view.eye) + ray * expected;
            if (ray.y < 0.0 && std::max(std::abs(hit.x), std::abs(hit.z)) < 11.9) {
                ASSERT_NEAR(metres(view, x, y, valueAt(frame.depth, x, y)), expected, depthBound(expected))
                    << x << "," << y;
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 300);
}

TEST_F(Engine, PillarDepthIsThatOfTheCylinder) {
    EngineScene scene;
    const double radius = 0.4;
    scene.pillars.push_back({{0.5F, 0.0F, -4.0F}, 0.4F, 6.0F});
    const View view{{0.0F, 1.7F, 0.0F}, {0.4F, 2.0F, -4.0F}};
    const Frame frame = render(scene, view, noon());
    // A chord of one of 40 facets lies inside the circle by at most r (1 - cos(pi / 40)), seen at the angle of the hit.
    const double sagitta = radius * (1.0 - std::cos(std::numbers::pi / 40.0));
    int compared = 0;
    for (std::uint32_t y = 20; y < 160; y += 5) {
        for (std::uint32_t x = 0; x < kWidth; x += 2) {
            const glm::dvec3 ray = rayThrough(view, x, y);
            const glm::dvec2 d(ray.x, ray.z);
            const glm::dvec2 c(-0.5, 4.0);
            const double a = glm::dot(d, d);
            const double b = glm::dot(d, c);
            const double discriminant = b * b - a * (glm::dot(c, c) - radius * radius);
            if (discriminant <= 0.0) {
                continue;
            }
            const double expected = (-b - std::sqrt(discriminant)) / a;
            const double facing = std::sqrt(discriminant / a) / radius;  // cosine of the angle of incidence, in plan
            const double height = double{view.eye.y} + ray.y * expected;
            if (facing < 0.3 || height < 0.6 || height > 5.2) {
                continue;  // silhouette, base and capital
            }
            const double bound = sagitta / (facing * std::sqrt(a)) + depthBound(expected);
            ASSERT_NEAR(metres(view, x, y, valueAt(frame.depth, x, y)), expected, bound) << x << "," << y;
            ++compared;
        }
    }
    EXPECT_GT(compared, 100);
}

TEST_F(Engine, BasinRimLiesAtItsHeight) {
    const View view{{0.05F, 6.0F, 0.02F}, {0.0F, 0.0F, -0.01F}};
    const Frame frame = render(courtyard(), view, noon());
    int rim = 0;
    for (std::uint32_t x = 0; x < kWidth; ++x) {
        const glm::dvec3 ray = rayThrough(view, x, kHeight / 2);
        const double expected = (0.85 - 6.0) / ray.y;
        const glm::dvec3 hit = glm::dvec3(view.eye) + ray * expected;
        const double out = std::max(std::abs(hit.x), std::abs(hit.z));
        if (out > 1.07 && out < 1.21) {
            EXPECT_NEAR(metres(view, x, kHeight / 2, valueAt(frame.depth, x, kHeight / 2)), expected,
                        depthBound(expected));
            ++rim;
        }
    }
    EXPECT_GT(rim, 4);
}

TEST_F(Engine, SkyIsTheFormulaWithinTwoSteps) {
    EngineScene scene;
    scene.enclosure_height = 0.0F;
    scene.floor_height = -1.0F;
    scene.floor_half_extent = 0.5F;
    const SluiceSky sky = noon();
    const glm::vec3 to_sun(sky.to_sun[0], sky.to_sun[1], sky.to_sun[2]);
    const std::array<glm::vec3, 5> targets{to_sun, glm::vec3(1.0F, 0.05F, 0.2F), glm::vec3(0.3F, 0.6F, -1.0F),
                                           glm::vec3(-0.2F, 0.95F, 0.1F), glm::vec3(1.0F, -0.2F, 1.0F)};
    int compared = 0;
    for (const glm::vec3& target : targets) {
        const View view{{0.0F, 1.0F, 0.0F}, glm::vec3(0.0F, 1.0F, 0.0F) + target};
        const Frame frame = render(scene, view, sky);
        for (std::uint32_t y = 0; y < kHeight; y += 3) {
            for (std::uint32_t x = 0; x < kWidth; x += 3) {
                if (valueAt(frame.depth, x, y) < 1.0F) {
                    continue;  // the floor
                }
                const glm::vec3 ray(rayThrough(view, x, y));
                const Vec3 expected = encodeSrgb(skyRadiance(sky, {ray.x, ray.y, ray.z}));
                for (std::uint32_t c = 0; c < 3; ++c) {
                    ASSERT_NEAR(valueAt(frame.colour, x, y, c), expected[c], 2.0F / 255.0F)
                        << x << "," << y << " channel " << c << " target " << target.x << " " << target.y;
                }
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 20000);
}

TEST(SkyFormula, HasTheValuesOfTheContract) {
    // By hand from plugin.h: overhead, at the horizon, a quarter down, and in the sun.
    SluiceSky sky{{0.1F, 0.2F, 0.4F}, {0.5F, 0.6F, 0.7F},  {0.3F, 0.2F, 0.1F},
                  {0.0F, 0.6F, 0.8F}, {10.0F, 9.0F, 8.0F}, {}};
    EXPECT_FLOAT_EQ(skyRadiance(sky, {0.0F, 1.0F, 0.0F})[2], 0.4F);
    EXPECT_FLOAT_EQ(skyRadiance(sky, {1.0F, 0.0F, 0.0F})[0], 0.5F);
    EXPECT_FLOAT_EQ(skyRadiance(sky, {-std::sqrt(0.75F), 0.25F, -0.433F})[0], 0.3F);
    EXPECT_FLOAT_EQ(skyRadiance(sky, {1.0F, -0.125F, 0.0F})[1], 0.4F);
    EXPECT_FLOAT_EQ(skyRadiance(sky, {1.0F, -0.6F, 0.0F})[1], 0.2F);
    EXPECT_NEAR(skyRadiance(sky, {0.0F, 0.6F, 0.8F})[0], 0.5F + (0.1F - 0.5F) * std::sqrt(0.6F) + 10.0F, 1e-4F);
}

TEST_F(Engine, TwoDrawsAreBitEqual) {
    auto screen = Screen::create(kWidth, kHeight);
    auto engine = LegacyEngine::create(courtyard());
    ASSERT_TRUE(screen.ok() && engine.ok());
    screen.value().bind();
    const SluiceCamera camera = cameraOf({{-4.0F, 4.0F, -3.0F}, {0.0F, 0.4F, 0.0F}});
    SluiceSky sky = noon();
    engine.value().draw(camera, sky);
    const Pixels colour = readColour(screen.value(), nullptr);
    const Pixels depth = readDepth(screen.value(), nullptr);
    sky.zenith[0] = 0.9F;  // the dome is kept between frames; a change and back must not leave a trace
    engine.value().draw(camera, sky);
    sky.zenith[0] = noon().zenith[0];
    engine.value().draw(camera, sky);
    EXPECT_EQ(readColour(screen.value(), nullptr).values, colour.values);
    EXPECT_EQ(readDepth(screen.value(), nullptr).values, depth.values);
}

TEST_F(Engine, DrawAndLifeLeaveStateAsItWas) {
    auto screen = Screen::create(64, 64);
    ASSERT_TRUE(screen.ok());
    screen.value().bind();
    glActiveTexture(GL_TEXTURE2);
    glEnable(GL_BLEND);
    glColor3f(0.25F, 0.5F, 0.75F);
    glMatrixMode(GL_TEXTURE);
    glTranslatef(0.5F, 0.0F, 0.0F);
    const StateSnapshot before = takeStateSnapshot();
    {
        auto engine = LegacyEngine::create(courtyard());
        ASSERT_TRUE(engine.ok());
        EXPECT_THAT(differences(before, takeStateSnapshot()), ::testing::IsEmpty()) << "create";
        engine.value().draw(cameraOf({{-4.0F, 4.0F, -3.0F}, {0.0F, 0.4F, 0.0F}}), noon());
        EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
        EXPECT_THAT(differences(before, takeStateSnapshot()), ::testing::IsEmpty()) << "draw";
    }
    EXPECT_THAT(differences(before, takeStateSnapshot()), ::testing::IsEmpty()) << "destroy";
}

TEST_F(Engine, PictureDoesNotDependOnTheCallersFixedFunctionState) {
    const View view{{-4.0F, 4.0F, -3.0F}, {0.0F, 0.4F, 0.0F}};
    const Frame plain = render(courtyard(), view, noon());
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 3, 3);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
    glDepthFunc(GL_NEVER);
    glDepthRange(0.5, 0.75);
    glFrontFace(GL_CW);
    glEnable(GL_LIGHT4);
    glEnable(GL_TEXTURE_GEN_S);
    glEnable(GL_CLIP_PLANE1);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glMatrixMode(GL_TEXTURE);
    glScalef(3.0F, 3.0F, 3.0F);
    const std::array<GLfloat, 4> glow{1.0F, 1.0F, 1.0F, 1.0F};
    glMaterialfv(GL_FRONT, GL_EMISSION, glow.data());
    const Frame again = render(courtyard(), view, noon());
    EXPECT_EQ(again.colour.values, plain.colour.values);
    EXPECT_EQ(again.depth.values, plain.depth.values);
}

TEST_F(Engine, ThePillarThrowsAShadowAwayFromTheSun) {
    EngineScene scene;
    scene.pillars.push_back({{0.0F, 0.0F, 0.0F}, 0.3F, 3.0F});
    const View view{{0.0F, 9.0F, 0.01F}, {0.0F, 0.0F, 0.0F}};
    SluiceSky sky = noon();
    sky.to_sun[0] = -0.8F;
    sky.to_sun[1] = 0.6F;
    sky.to_sun[2] = 0.0F;
    const Frame lit = render(scene, view, sky);
    // Mean brightness of the floor 2 m to either side of the pillar, in the plane of the sun.
    const auto brightness = [&](double x_metres) {
        const double pixels = x_metres / 9.0 / std::tan(glm::radians(58.3 / 2.0)) * kHeight / 2.0;
        const auto column = static_cast<std::uint32_t>(kWidth / 2.0 + pixels);
        double sum = 0.0;
        for (std::uint32_t dx = 0; dx < 12; ++dx) {
            sum += double{valueAt(lit.colour, column - 6 + dx, kHeight / 2, 1)};
        }
        return sum / 12.0;
    };
    EXPECT_LT(brightness(2.0), 0.75 * brightness(-2.0));
}

TEST_F(Engine, BadScenesAreErrorsThatNameTheThing) {
    EngineScene scene = courtyard();
    scene.pillars.push_back({{0.0F, 0.0F, 0.0F}, -0.5F, 2.0F});
    const auto pillar = LegacyEngine::create(scene);
    ASSERT_FALSE(pillar.ok());
    EXPECT_THAT(pillar.error().message(), ::testing::HasSubstr("pillar 1"));
    EXPECT_THAT(pillar.error().message(), ::testing::HasSubstr("-0.5"));
    scene = courtyard();
    scene.fog_density = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(LegacyEngine::create(scene).ok());
    scene = courtyard();
    scene.basins[0].wall = 0.0F;
    EXPECT_FALSE(LegacyEngine::create(scene).ok());
}

TEST_F(Engine, GivesBackEveryTextureAndList) {
    const auto alive = [] {
        int count = 0;
        for (GLuint name = 1; name < 256; ++name) {
            count += glIsTexture(name) == GL_TRUE ? 1 : 0;
            count += glIsList(name) == GL_TRUE ? 1 : 0;
        }
        return count;
    };
    const int before = alive();
    {
        auto engine = LegacyEngine::create(courtyard());
        ASSERT_TRUE(engine.ok());
        EXPECT_GT(alive(), before);
    }
    EXPECT_EQ(alive(), before);
}

}  // namespace
}  // namespace sluice::host::test
