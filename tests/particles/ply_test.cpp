// SPDX-License-Identifier: MIT
// What PLY files of other writers mean here.
#include "files.hpp"

namespace sluice::particles::test {
namespace {

using testing::ElementsAre;
using testing::FloatEq;
using testing::FloatNear;
using testing::IsEmpty;

ParticleSet parsed(const File& file) {
    Result<ParticleSet> set = parsePly(file, "test.ply");
    EXPECT_TRUE(set.ok()) << set.error().message();
    return set ? std::move(set).value() : ParticleSet{};
}

TEST(Ply, AsciiReadsPropertiesInAnyOrderAndOfAnyType) {
    const ParticleSet set = parsed(text(
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty uchar quality\nproperty double z\n"
        "property short y\nproperty list uchar int neighbours\nproperty float32 x\nproperty float64 velocity_z\n"
        "property float velocity_x\nproperty float velocity_y\nend_header\n"
        "7 3.5 -2 2 10 11 1.25 6 4 5\n7 +0.5 20 0 -1e-3 0 0 0\n"));
    EXPECT_THAT(set.position, ElementsAre(1.25F, -2.0F, 3.5F, -1e-3F, 20.0F, 0.5F));
    EXPECT_THAT(set.velocity, ElementsAre(4, 5, 6, 0, 0, 0));
    EXPECT_THAT(set.colour, IsEmpty());
    EXPECT_EQ(set.radius, 0.0F);
}

TEST(Ply, ElementsBeforeAndAfterTheVerticesArePassedOver) {
    const ParticleSet set = parsed(text(
        "ply\nformat ascii 1.0\nelement camera 1\nproperty float fov\nproperty list uchar float m\nelement vertex 1\n"
        "property float x\nproperty float y\nproperty float z\nelement face 2\nproperty list uchar int i\n"
        "end_header\n60 3 1 2 3\n1 2 3\n3 0 0 0\n4 0 0 0 0\n"));
    EXPECT_THAT(set.position, ElementsAre(1, 2, 3));
}

TEST(Ply, BinaryPassesOverListsAndElements) {
    File file = text(
        "ply\nformat binary_little_endian 1.0\nelement cell 2\nproperty list ushort double m\nproperty char c\n"
        "element vertex 2\nproperty list uchar short n\nproperty double x\nproperty int y\nproperty float z\n"
        "property ushort w\nelement face 1\nproperty list int uchar i\nend_header\n");
    appendLittle(file, std::uint16_t{2});
    appendLittle(file, 1.0);
    appendLittle(file, 2.0);
    appendLittle(file, std::int8_t{-1});
    appendLittle(file, std::uint16_t{0});
    appendLittle(file, std::int8_t{-1});
    for (const double x : {0.5, -8.0}) {
        appendLittle(file, std::uint8_t{1});
        appendLittle(file, std::int16_t{-5});
        appendLittle(file, x);
        appendLittle(file, std::int32_t{-70000});
        appendLittle(file, 2.5F);
        appendLittle(file, std::uint16_t{9});
    }
    appendLittle(file, std::int32_t{3});
    appendText(file, "abc");
    const ParticleSet set = parsed(file);
    EXPECT_THAT(set.position, ElementsAre(0.5F, -70000.0F, 2.5F, -8.0F, -70000.0F, 2.5F));
}

TEST(Ply, LinesMayEndWithCarriageReturns) {
    const ParticleSet set = parsed(text(
        "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
        "end_header\r\n1 2 3\r\n\r\n"));
    EXPECT_THAT(set.position, ElementsAre(1, 2, 3));
}

TEST(Ply, LastLineNeedsNoNewline) {
    EXPECT_THAT(
        parsed(text("ply\nformat ascii 1.0\nelement vertex 2\nproperty char x\nproperty char y\nproperty char z\n"
                    "end_header\n1 2 3\n4 5 6"))
            .position,
        ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(Ply, ByteColoursCarryTheSrgbCurveAndFloatColoursAreLinear) {
    constexpr std::string_view kHead =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    const ParticleSet bytes = parsed(text(std::string(kHead).append(
        "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n0 0 0 255 128 10\n")));
    // 128/255 and 10/255 by IEC 61966-2-1, to seven places.
    EXPECT_THAT(bytes.colour, ElementsAre(1.0F, FloatNear(0.2158605F, 1e-6F), FloatNear(0.0030353F, 1e-6F)));
    const ParticleSet shorts = parsed(text(std::string(kHead).append(
        "property ushort red\nproperty ushort green\nproperty ushort blue\nend_header\n0 0 0 65535 0 32896\n")));
    EXPECT_THAT(shorts.colour, ElementsAre(1.0F, 0.0F, FloatNear(0.2158605F, 1e-6F)));
    const ParticleSet floats = parsed(text(std::string(kHead).append(
        "property float red\nproperty float green\nproperty float blue\nend_header\n0 0 0 0.5 1.5 -1\n")));
    EXPECT_THAT(floats.colour, ElementsAre(0.5F, 1.0F, 0.0F));
}

TEST(Ply, RadiusComesFromObjInfoOrFromTheVertices) {
    constexpr std::string_view kEnd = "property float x\nproperty float y\nproperty float z\n";
    EXPECT_EQ(
        parsed(text(std::string("ply\nformat ascii 1.0\nobj_info radius 0.025\nobj_info other 1\nelement vertex 0\n")
                        .append(kEnd)
                        .append("end_header\n")))
            .radius,
        0.025F);
    const std::string two = std::string("ply\nformat ascii 1.0\nelement vertex 2\n").append(kEnd);
    EXPECT_EQ(parsed(text(two + "property float radius\nend_header\n0 0 0 0.1\n0 0 0 0.1\n")).radius, 0.1F);
    EXPECT_THAT(parsed(text(two + "property double pscale\nend_header\n0 0 0 0.1\n0 0 0 0.3\n")).radius, FloatEq(0.2F));
}

}  // namespace
}  // namespace sluice::particles::test
