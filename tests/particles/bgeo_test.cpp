// SPDX-License-Identifier: MIT
// What classic bgeo files of other writers mean here.
#include "files.hpp"
#include "gzip.hpp"

namespace sluice::particles::test {
namespace {

using testing::ElementsAre;
using testing::FloatEq;
using testing::IsEmpty;

ParticleSet parsed(const File& file) {
    Result<ParticleSet> set = parseBgeo(file, "test.bgeo");
    EXPECT_TRUE(set.ok()) << set.error().message();
    return set ? std::move(set).value() : ParticleSet{};
}

/// Two points as Partio writes them for SPlisHSPlasH: an integer id, a vector velocity, an indexed string, a density.
File likePartio() {
    File file = bgeo({.points = 2, .point_attributes = 4});
    appendDefinition(file, "id", 1, 1);
    appendDefinition(file, "velocity", 3, 5);
    appendString(file, "material");
    appendBig(file, std::uint16_t{1});
    appendBig(file, std::uint32_t{4});
    appendBig(file, std::uint32_t{2});
    appendString(file, "water");
    appendString(file, "");
    appendDefinition(file, "density", 1, 0);
    for (const float k : {0.0F, 10.0F}) {
        appendFloats(file, {k + 1, k + 2, k + 3, 1});
        appendBig(file, std::uint32_t{0xFFFFFFFF});  // as a float this id would be NaN: it must not be looked at
        appendFloats(file, {k + 4, k + 5, k + 6});
        appendBig(file, std::uint32_t{1});
        appendFloats(file, {1000});
    }
    file.push_back(std::byte{0x00});
    file.push_back(std::byte{0xFF});
    return file;
}

TEST(Bgeo, ReadsPositionsAndVelocityAmongOtherAttributes) {
    const ParticleSet set = parsed(likePartio());
    EXPECT_THAT(set.position, ElementsAre(1, 2, 3, 11, 12, 13));
    EXPECT_THAT(set.velocity, ElementsAre(4, 5, 6, 14, 15, 16));
    EXPECT_THAT(set.colour, IsEmpty());
    EXPECT_EQ(set.radius, 0.0F);
}

TEST(Bgeo, GzipIsRecognisedByItsMagicWhateverTheName) {
    const Result<std::vector<std::byte>> packed = deflateGzip(likePartio(), "test");
    ASSERT_TRUE(packed.ok());
    EXPECT_THAT(parsed(packed.value()).position, ElementsAre(1, 2, 3, 11, 12, 13));
}

TEST(Bgeo, GzipOfSeveralMembersIsOneFile) {
    const File whole = likePartio();
    const std::span<const std::byte> all(whole);
    std::vector<std::byte> packed = deflateGzip(all.first(30), "test").value();
    const std::vector<std::byte> rest = deflateGzip(all.subspan(30), "test").value();
    packed.insert(packed.end(), rest.begin(), rest.end());
    EXPECT_THAT(parsed(packed).velocity, ElementsAre(4, 5, 6, 14, 15, 16));
}

TEST(Bgeo, HoudiniNamesAreReadAndColourIsClamped) {
    File file = bgeo({.points = 1, .point_attributes = 3});
    appendDefinition(file, "Cd", 3, 0);
    appendDefinition(file, "v", 3, 5);
    appendDefinition(file, "pscale", 1, 0);
    appendFloats(file, {1, 2, 3, 1, 0.25F, 4, -1, 7, 8, 9, 0.05F});
    const ParticleSet set = parsed(file);
    EXPECT_THAT(set.colour, ElementsAre(0.25F, 1.0F, 0.0F));
    EXPECT_THAT(set.velocity, ElementsAre(7, 8, 9));
    EXPECT_EQ(set.radius, 0.05F);
}

TEST(Bgeo, DifferentRadiiGiveTheirMean) {
    File file = bgeo({.points = 2, .point_attributes = 1});
    appendDefinition(file, "radius", 1, 0);
    appendFloats(file, {1, 2, 3, 1, 0.1F, 1, 2, 3, 1, 0.3F});
    EXPECT_THAT(parsed(file).radius, FloatEq(0.2F));
}

TEST(Bgeo, RadiusMayBeADetailAttributeButThePointsWin) {
    const auto make = [](bool at_points) {
        File file = bgeo({.points = 1, .point_attributes = at_points ? 1U : 0U, .detail_attributes = 2});
        if (at_points) {
            appendDefinition(file, "pscale", 1, 0);
        }
        appendFloats(file, {1, 2, 3, 1});
        if (at_points) {
            appendFloats(file, {0.5F});
        }
        appendDefinition(file, "time", 1, 0);
        appendDefinition(file, "pscale", 1, 0);
        appendFloats(file, {99, 0.25F});
        return file;
    };
    EXPECT_EQ(parsed(make(false)).radius, 0.25F);
    EXPECT_EQ(parsed(make(true)).radius, 0.5F);
}

TEST(Bgeo, PointsOfAFileWithPrimitivesAreRead) {
    File file = bgeo({.points = 1, .primitives = 1, .primitive_groups = 1});
    appendFloats(file, {1, 2, 3, 1});
    appendText(file, "primitives and groups follow, which are not looked at");
    EXPECT_THAT(parsed(file).position, ElementsAre(1, 2, 3));
}

TEST(Bgeo, LongNamesUseAWideLength) {
    File file = bgeo({.points = 1, .point_attributes = 1});
    appendBig(file, std::uint16_t{0xFFFF});
    appendBig(file, std::uint32_t{70000});
    appendText(file, std::string(70000, 'n'));
    appendBig(file, std::uint16_t{2});
    appendBig(file, std::uint32_t{1});
    appendFloats(file, {0, 0});
    appendFloats(file, {1, 2, 3, 1, 0, 0});
    EXPECT_THAT(parsed(file).position, ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace sluice::particles::test
