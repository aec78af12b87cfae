// SPDX-License-Identifier: MIT
// Triangle meshes as solids: the grid of distances against analytic ones in doubles, what is refused, and fluid about
// them.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "simulation/distance_grid.hpp"
#include "simulation_rig.hpp"

namespace sluice::vk::test {
namespace {

using ::testing::HasSubstr;

constexpr float kRadius = 0.02F;
constexpr double kSpacing = 0.04;
constexpr Triple kLow{-1, -1, -1};
constexpr Triple kHigh{1, 1, 1};

/// `bands` rings of twice as many quads, each cut in two; triangles at the poles.
Mesh sphereMesh(const Vector& centre, double radius, std::uint32_t bands) {
    Mesh mesh{"sphere.obj", {}, {}};
    const std::uint32_t around = 2 * bands;
    for (std::uint32_t band = 0; band <= bands; ++band) {
        for (std::uint32_t k = 0; k < around; ++k) {
            const double down = std::numbers::pi * band / bands;
            const double turn = 2.0 * std::numbers::pi * k / around;
            const bool pole = band == 0 || band == bands;
            const double wide_ = pole ? 0.0 : std::sin(down);
            mesh.corners.push_back(
                plus(centre, times(radius, Vector{wide_ * std::cos(turn), std::cos(down), wide_ * std::sin(turn)})));
        }
    }
    for (std::uint32_t band = 0; band < bands; ++band) {
        for (std::uint32_t k = 0; k < around; ++k) {
            const std::uint32_t a = band * around + k;
            const std::uint32_t b = band * around + (k + 1) % around;
            if (band > 0) {
                mesh.triangles.push_back({a, b, b + around});
            }
            if (band + 1 < bands) {
                mesh.triangles.push_back({a, b + around, a + around});
            }
        }
    }
    return mesh;
}

Mesh boxMesh(const Vector& centre, const Vector& half) {
    Mesh mesh{"box.obj", {}, {}};
    for (unsigned corner = 0; corner < 8; ++corner) {
        mesh.corners.push_back({centre[0] + ((corner & 1U) != 0 ? half[0] : -half[0]),
                                centre[1] + ((corner & 2U) != 0 ? half[1] : -half[1]),
                                centre[2] + ((corner & 4U) != 0 ? half[2] : -half[2])});
    }
    for (const auto& [a, b, c, d] : std::initializer_list<std::array<std::uint32_t, 4>>{
             {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    }
    return mesh;
}

DistanceGrid gridOf(const std::vector<Mesh>& meshes) {
    Result<DistanceGrid> grid = distanceGrid(meshes, kRadius, kLow, kHigh);
    EXPECT_TRUE(grid.ok()) << grid.error().message();
    return grid ? std::move(grid).value() : DistanceGrid{};
}

Vector nodeOf(const DistanceGrid& grid, std::size_t i) {
    const std::size_t x = i % grid.size[0];
    const std::size_t y = i / grid.size[0] % grid.size[1];
    const std::size_t z = i / grid.size[0] / grid.size[1];
    return plus(grid.low,
                times(grid.spacing, Vector{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
}

TEST(DistanceGrid, OfASphereIsWithinItsCurvatureOfTheAnalyticDistance) {
    const Vector centre{0.11, -0.07, 0.05};
    constexpr double kWide = 0.3;
    constexpr std::uint32_t kBands = 32;
    const DistanceGrid grid = gridOf({sphereMesh(centre, kWide, kBands)});
    const double flat = 2.0 * kWide * (1.0 - std::cos(std::numbers::pi / (2.0 * kBands)));
    Dice dice(3);
    for (int i = 0; i < 20000; ++i) {
        const Vector x = plus(centre, {double{dice.between(-0.4F, 0.4F)}, double{dice.between(-0.4F, 0.4F)},
                                       double{dice.between(-0.4F, 0.4F)}});
        const double out = length(minus(x, centre));
        if (std::abs(out - kWide) > 2.0 * kSpacing) {
            continue;
        }
        const SolidContact contact = contactWith(grid, x);
        const double bound = kSpacing * kSpacing / (4.0 * (out - std::sqrt(3.0) * kSpacing)) + flat;
        ASSERT_LT(std::abs(contact.distance - (out - kWide)), bound) << out;
        ASSERT_GT(dot(contact.normal, minus(x, centre)) / out, 0.98) << out;
    }
}

TEST(DistanceGrid, OfABoxIsExactAtNodesNearItAndHasTheRightSignAtAll) {
    const Solid box = boxSolid({0.1F, 0.2F, -0.3F}, {0.31F, 0.2F, 0.23F});
    const DistanceGrid grid = gridOf({boxMesh(wide(box.a), wide(box.b))});
    std::size_t near = 0;
    for (std::size_t i = 0; i < grid.nodes.size(); ++i) {
        const double exact = contactWith(box, nodeOf(grid, i)).distance;
        if (std::abs(exact) < 0.08) {
            ++near;
            ASSERT_NEAR(double{grid.nodes[i]}, exact, 1e-6) << i;
        } else {
            ASSERT_EQ(grid.nodes[i] < 0.0F, exact < 0.0) << i;
            ASSERT_GT(std::abs(double{grid.nodes[i]}), std::abs(exact) - 1e-6) << i;
        }
    }
    EXPECT_GT(near, 2000U);
    Dice dice(4);
    for (int i = 0; i < 20000; ++i) {  // no distance is steeper than 1, so no node of a cell is more than this off
        const Vector x{double{dice.between(-0.3F, 0.5F)}, double{dice.between(-0.1F, 0.5F)},
                       double{dice.between(-0.6F, 0.0F)}};
        const double exact = contactWith(box, x).distance;
        if (std::abs(exact) < 0.04) {
            ASSERT_NEAR(contactWith(grid, x).distance, exact, 0.5 * std::sqrt(3.0) * kSpacing);
        }
    }
}

TEST(DistanceGrid, OfSeveralMeshesIsThatOfTheNearestAndOneWithinTheDomainsWallsIsCutOff) {
    const std::vector<Mesh> meshes{sphereMesh({-0.5, 0, 0}, 0.2, 12), boxMesh({1.0, 0, 0}, {0.2, 0.2, 0.2})};
    const DistanceGrid grid = gridOf(meshes);
    EXPECT_LT(contactWith(grid, {-0.5, 0, 0}).distance, -0.15);
    EXPECT_LT(contactWith(grid, {0.99, 0, 0}).distance, -0.1);
    EXPECT_GT(contactWith(grid, {0.4, 0, 0}).distance, 0.3);
    EXPECT_GT(contactWith(grid, {0, 0.9, 0}).distance, 1e6) << "outside the grid";
    // The domain in the midst of a mesh, and far from it.
    EXPECT_LT(contactWith(gridOf({boxMesh({0, 0, 0}, {9, 9, 9})}), {0, 0, 0}).distance, -7.0);
    EXPECT_TRUE(gridOf({boxMesh({5, 0, 0}, {1, 1, 1})}).nodes.empty());
    EXPECT_TRUE(gridOf({}).nodes.empty());
}

std::string refusal(const Mesh& mesh, float radius = kRadius) {
    const Result<DistanceGrid> grid = distanceGrid(std::vector<Mesh>{mesh}, radius, kLow, kHigh);
    return grid.ok() ? "" : grid.error().message();
}

TEST(DistanceGrid, RefusesWhatIsNoClosedSurfaceAndSaysWhere) {
    const Mesh box = boxMesh({0, 0, 0}, {0.5, 0.5, 0.5});
    EXPECT_EQ(refusal(box), "");
    Mesh open = box;
    open.triangles.pop_back();
    EXPECT_THAT(refusal(open), HasSubstr("box.obj: expected a closed surface of triangles, found the edge from ["));
    EXPECT_THAT(refusal(open), HasSubstr("alone"));
    Mesh turned = box;
    std::swap(turned.triangles[3][0], turned.triangles[3][1]);
    EXPECT_THAT(refusal(turned), HasSubstr("in the same direction"));
    Mesh inside_out = box;
    for (auto& triangle : inside_out.triangles) {
        std::swap(triangle[0], triangle[1]);
    }
    EXPECT_THAT(refusal(inside_out), HasSubstr("inside out, of volume -1 m^3"));
    EXPECT_THAT(refusal(Mesh{"none.obj", box.corners, {}}), HasSubstr("none.obj: expected a closed surface"));
    Mesh bad = box;
    bad.corners[5][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusal(bad), HasSubstr("corner 6 at [0.5, nan, 0.5]"));
    bad = box;
    bad.triangles[2][1] = 8;
    EXPECT_THAT(refusal(bad), HasSubstr("triangle 3 with corner 9 of 8"));
    Mesh thin = box;
    thin.corners.push_back({0, -0.5, -0.5});  // in the midst of the edge from 0 to 1
    thin.triangles[9] = {1, 8, 3};            // was 0, 3, 1
    thin.triangles.push_back({8, 0, 3});
    thin.triangles.push_back({1, 0, 8});
    EXPECT_THAT(refusal(thin), HasSubstr("without an area"));
    EXPECT_THAT(refusal(box, 0.001F), HasSubstr("nodes, 0.002"));
    // Corners that a file repeats, as it does where texture coordinates part, are one.
    Mesh apart{"apart.obj", {}, {}};
    for (const auto& triangle : box.triangles) {
        const auto first = static_cast<std::uint32_t>(apart.corners.size());
        for (const std::uint32_t corner : triangle) {
            apart.corners.push_back(box.corners[corner]);
        }
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    EXPECT_EQ(refusal(apart), "");
}

class SimulationMesh : public SimulationTest {
  protected:
    static SimulationSettings with(const std::vector<Mesh>& meshes) {
        SimulationSettings settings;
        settings.low = {0, 0, 0};
        settings.high = {1, 1, 0.4F};
        auto grid = distanceGrid(meshes, settings.radius, settings.low, settings.high);
        EXPECT_TRUE(grid.ok()) << grid.error().message();
        settings.meshes = std::make_shared<const DistanceGrid>(std::move(grid).value());
        return settings;
    }
    /// Outside a ball.
    static std::vector<float> about(const Solid& ball, float gap) {
        std::vector<float> kept;
        const std::vector<float> all = lattice({0.1F, 0.1F, 0.0F}, 18, 14, 10, 0.04F, 0.004F, 6);
        for (std::size_t i = 0; i < all.size(); i += 3) {
            if (distanceTo(ball, {all[i], all[i + 1], all[i + 2]}) > double{gap}) {
                kept.insert(kept.end(), all.begin() + static_cast<std::ptrdiff_t>(i),
                            all.begin() + static_cast<std::ptrdiff_t>(i + 3));
            }
        }
        return kept;
    }
};

double farthest(const ParticleState& a, const ParticleState& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.position.size(); ++i) {
        most = std::max(most, std::abs(double{a.position[i]} - double{b.position[i]}));
    }
    return most;
}

TEST_F(SimulationMesh, AStepAboutAMeshOfASphereIsThatAboutTheSphere) {
    const Solid ball = sphereSolid({0.45F, 0.35F, 0.2F}, 0.18F);
    SimulationSettings meshed = with({sphereMesh(wide(ball.a), double{ball.radius}, 32)});
    meshed.tension = 0.1F;
    meshed.adhesion = 0.5F;
    SimulationSettings exact = meshed;
    exact.meshes = nullptr;
    exact.solids = {ball};
    SimulationSettings empty = exact;
    empty.solids.clear();
    const std::vector<float> positions = about(ball, 0.012F);
    const auto stepped = [&](const SimulationSettings& settings) {
        const auto solver = make(settings, positions);
        EXPECT_TRUE(solver->step(0.004).ok());
        return solver->read().value();
    };
    const ParticleState reference = stepped(exact);
    const double off = farthest(stepped(meshed), reference);
    RecordProperty("off_in_radii", std::to_string(off / double{kRadius}));
    EXPECT_LT(off, 0.25 * double{kRadius});
    EXPECT_GT(farthest(stepped(empty), reference), 2.0 * off) << "the ball does nothing";
}

TEST_F(SimulationMesh, NothingEntersAMeshAndItRefusesWhoIsInItAndBodies) {
    const Solid ball = sphereSolid({0.3F, 0.05F, 0.2F}, 0.12F);
    const Solid box = boxSolid({0.7F, 0.1F, 0.2F}, {0.08F, 0.1F, 0.08F});
    SimulationSettings settings =
        with({sphereMesh(wide(ball.a), double{ball.radius}, 16), boxMesh(wide(box.a), wide(box.b))});
    const auto solver = make(settings, lattice({0.1F, 0.3F, 0}, 18, 8, 10, 0.04F, 0.002F, 5));
    for (int frame = 0; frame < 10; ++frame) {
        const auto report = solver->advance(1.0 / 30.0, 1.0 / 120.0);
        ASSERT_TRUE(report.ok()) << report.error().message();
    }
    const ParticleState state = solver->read().value();
    double nearest = 1.0;
    double nearest_of_grid = 1.0;
    for (std::size_t i = 0; i < state.position.size(); i += 3) {
        const Triple x{state.position[i], state.position[i + 1], state.position[i + 2]};
        nearest = std::min({nearest, distanceTo(ball, x), distanceTo(box, x)});
        nearest_of_grid = std::min(nearest_of_grid, contactWith(*settings.meshes, wide(x)).distance);
    }
    RecordProperty("nearest_in_radii", std::to_string(nearest / double{kRadius}));
    RecordProperty("nearest_of_grid_in_radii", std::to_string(nearest_of_grid / double{kRadius}));
    EXPECT_GT(nearest, 0.0);
    EXPECT_LT(nearest, 1.5 * double{kRadius}) << "nothing came near";
    EXPECT_GT(nearest_of_grid, 0.8 * double{kRadius});

    const Status inside = solver->setParticles(std::vector<float>{0.7F, 0.1F, 0.2F}, {});
    ASSERT_FALSE(inside.ok());
    EXPECT_THAT(inside.error().message(), HasSubstr("a position outside the meshes"));
    settings.bodies.push_back({SolidKind::Sphere, {0.5F, 0.8F, 0.2F}, {0.1F, 0.1F, 0.1F}, 0.0F, 0.5F, {}, {}, {}});
    EXPECT_THAT(checkSettings(settings).error().message(), HasSubstr("none among meshes"));
}

}  // namespace
}  // namespace sluice::vk::test
