// SPDX-License-Identifier: MIT
#include <limits>

#include "files.hpp"
#include "gzip.hpp"

namespace sluice::particles::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class MalformedBgeo : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedBgeo, IsRefusedWithPlaceExpectedAndFound) {
    expectRefused(parseBgeo, GetParam());
}

/// A header and then whatever `fill` appends.
template <typename Fill>
File with(const BgeoHeader& header, const Fill& fill) {
    File file = bgeo(header);
    fill(file);
    return file;
}

/// One point with one attribute of three values.
File onePointWith(std::string_view name, std::uint16_t size, std::uint32_t type, std::initializer_list<float> values) {
    return with({.points = 1, .point_attributes = 1}, [&](File& file) {
        appendDefinition(file, name, size, type);
        appendFloats(file, {1, 2, 3, 1});
        appendFloats(file, values);
    });
}

File cut(File file, std::size_t size) {
    file.resize(size);
    return file;
}

File zipped(const File& file) {
    return deflateGzip(file, "zipped").value();
}

File joined(File file, std::string_view more) {
    appendText(file, more);
    return file;
}

File damaged(File file, std::size_t at) {
    file[at] ^= std::byte{0xFF};
    return file;
}

INSTANTIATE_TEST_SUITE_P(
    Header, MalformedBgeo,
    testing::Values(
        Malformed{"Empty", {}, {"at byte 0", "expected 'BgeoV'", "an empty file"}},
        Malformed{"WrongMagic", text("Bgeo!"), {"at byte 0", "expected 'BgeoV'", "found 'Bgeo!'"}},
        Malformed{"JsonText",
                  text("[\"fileversion\",\"18.0\"]"),
                  {"at byte 0", "classic bgeo", "Houdini's JSON geometry", "gconvert in.bgeo out.bhclassic"}},
        Malformed{
            "JsonBinary", text("\x7fNSJb..."), {"at byte 0", "classic bgeo", "Houdini's JSON geometry", ".bhclassic"}},
        Malformed{"Blosc", text("scf1...."), {"at byte 0", "Blosc", ".bhclassic"}},
        Malformed{"VersionMissing", text("BgeoV"), {"at byte 5", "4 bytes for the version", "0 bytes to the end"}},
        Malformed{"Version6", bgeo({.version = 6}), {"at byte 5", "expected version 5", "found version 6"}},
        Malformed{"HeaderCut",
                  cut(bgeo({}), 20),
                  {"at byte 17", "4 bytes for the number of point groups", "3 bytes to the end"}},
        Malformed{
            "NegativePoints", bgeo({.points = 0xFFFFFFFEU}), {"at byte 9", "a number of points from 0", "found -2"}},
        Malformed{"NegativeDetails",
                  bgeo({.detail_attributes = 0x80000000U}),
                  {"at byte 37", "a number of detail attributes from 0", "found -2147483648"}},
        Malformed{"AbsurdPoints",
                  bgeo({.points = 0x7FFFFFFFU}),
                  {"at byte 9", "at most 268435456 particles", "found 2147483647"}},
        Malformed{"PointsRunOut",
                  bgeo({.points = 268435456U}),
                  {"at byte 41", "268435456 points of 16 bytes", "0 bytes to the end"}},
        Malformed{"AttributesRunOut",
                  bgeo({.point_attributes = 0x7FFFFFFFU}),
                  {"at byte 41", "2 bytes for the length of the name of point attribute 0 of 2147483647", "0 bytes"}}),
    titleOf);

INSTANTIATE_TEST_SUITE_P(
    Attributes, MalformedBgeo,
    testing::Values(Malformed{"NameRunsOut",
                              with({.point_attributes = 1},
                                   [](File& f) {
                                       appendBig(f, std::uint16_t{500});
                                       appendText(f, "v");
                                   }),
                              {"at byte 43", "500 bytes for the name of point attribute 0", "1 bytes"}},
                    Malformed{"LongNameRunsOut",
                              with({.point_attributes = 1},
                                   [](File& f) {
                                       appendBig(f, std::uint16_t{0xFFFF});
                                       appendBig(f, 0xFFFFFFF0U);
                                   }),
                              {"at byte 47", "4294967280 bytes for the name", "0 bytes"}},
                    Malformed{"StringType",
                              onePointWith("name", 8, 2, {}),
                              {"at byte 49", "attribute 'name'", "found type 2", "delete the string attribute"}},
                    Malformed{"UnknownType",
                              onePointWith("v", 3, 77, {1, 2, 3}),
                              {"at byte 46", "type 0 (float), 1 (int), 4 (index) or 5 (vector)", "found type 77"}},
                    Malformed{"DefaultsRunOut",
                              with({.point_attributes = 1},
                                   [](File& f) {
                                       appendString(f, "v");
                                       appendBig(f, std::uint16_t{65535});
                                       appendBig(f, std::uint32_t{5});
                                   }),
                              {"at byte 50", "262140 bytes for the defaults of attribute 'v'", "0 bytes"}},
                    Malformed{"IndexTableRunsOut",
                              with({.point_attributes = 1},
                                   [](File& f) {
                                       appendString(f, "s");
                                       appendBig(f, std::uint16_t{1});
                                       appendBig(f, std::uint32_t{4});
                                       appendBig(f, 0xFFFFFFFFU);
                                   }),
                              {"at byte 54", "a string of attribute 's'", "0 bytes"}},
                    Malformed{"VelocityOfTwo",
                              onePointWith("v", 2, 0, {1, 2}),
                              {"at byte 41", "attribute 'v' as 3 floats", "found 2 of type 0"}},
                    Malformed{"IntegerVelocity",
                              onePointWith("velocity", 3, 1, {1, 2, 3}),
                              {"at byte 41", "attribute 'velocity' as 3 floats", "of type 1"}},
                    Malformed{"RadiusOfThree",
                              onePointWith("pscale", 3, 0, {1, 2, 3}),
                              {"at byte 41", "attribute 'pscale' as 1 float,"}},
                    Malformed{"EmptyRadius",
                              onePointWith("pscale", 0, 0, {}),
                              {"at byte 41", "attribute 'pscale' as 1 float,", "found 0 of type 0"}},
                    Malformed{"NanPosition",
                              with({.points = 2},
                                   [](File& f) {
                                       appendFloats(f, {1, 2, 3, 1, 1, kNan, 3, 1});
                                   }),
                              {"at byte 57", "the position of particle 1 finite", "(1, nan, 3)"}},
                    Malformed{"NanVelocity",
                              onePointWith("v", 3, 5, {1, 2, kNan}),
                              {"at byte 78", "the velocity of particle 0 finite", "(1, 2, nan)"}},
                    Malformed{"InfiniteColour",
                              onePointWith("Cd", 3, 0, {1, std::numeric_limits<float>::infinity(), 0}),
                              {"at byte 79", "the colour of particle 0 finite"}},
                    Malformed{"RadiusZero",
                              onePointWith("pscale", 1, 0, {0}),
                              {"at byte 75", "particle radius", "found 0 for particle 0"}},
                    Malformed{"PointCut",
                              with({.points = 2},
                                   [](File& f) {
                                       appendFloats(f, {1, 2, 3, 1, 1, 2, 3});
                                   }),
                              {"at byte 41", "2 points of 16 bytes", "28 bytes to the end"}},
                    Malformed{"Trailing",
                              with({.points = 1},
                                   [](File& f) {
                                       appendFloats(f, {1, 2, 3, 1});
                                       appendText(f, "more");
                                   }),
                              {"at byte 57", "the end of the file or the extra section", "4 bytes from 'more'"}},
                    Malformed{"DetailValuesRunOut",
                              with({.detail_attributes = 1}, [](File& f) { appendDefinition(f, "t", 2, 0); }),
                              {"at byte 58", "8 bytes for the values of the detail attributes", "0 bytes"}},
                    Malformed{"DetailRadiusNan",
                              with({.detail_attributes = 1},
                                   [](File& f) {
                                       appendDefinition(f, "radius", 1, 0);
                                       appendFloats(f, {kNan});
                                   }),
                              {"at byte 59", "particle radius", "found nan"}}),
    titleOf);

INSTANTIATE_TEST_SUITE_P(
    Gzip, MalformedBgeo,
    testing::Values(
        Malformed{"Magic", text("\x1f\x8b"), {"at byte 2", "more gzip data", "the end of the file", "cut short"}},
        Malformed{"CutShort", cut(zipped(bgeo({})), 25), {"at byte 25", "more gzip data", "cut short"}},
        Malformed{"NoDeflate", text("\x1f\x8bXXXXXXXXXXXX"), {"at byte ", "sound gzip data", "damaged"}},
        Malformed{"WrongChecksum",
                  damaged(zipped(bgeo({})), zipped(bgeo({})).size() - 6),
                  {"sound gzip data", "incorrect data check"}},
        Malformed{"WrongLength",
                  damaged(zipped(bgeo({})), zipped(bgeo({})).size() - 1),
                  {"sound gzip data", "incorrect length check"}},
        Malformed{
            "Trailing", joined(zipped(bgeo({})), "xyz"), {"the end of the file after the gzip data", "3 more bytes"}},
        Malformed{"PlaceInInflatedData",
                  zipped(bgeo({.version = 9})),
                  {"at byte 5 of the inflated data", "expected version 5", "found version 9"}},
        Malformed{"EmptyInside", zipped({}), {"'BgeoV'", "an empty file"}},
        Malformed{"ZippedTwice", zipped(zipped(bgeo({}))), {"at byte 0 of the inflated data", "'BgeoV'", "\\x1f\\x8b"}},
        Malformed{"Bomb",
                  zipped(File(std::size_t{8} << 20U)),
                  {"at most ", "bytes of inflated data", "found more", "gunzip"}}),
    titleOf);

}  // namespace
}  // namespace sluice::particles::test
