// SPDX-License-Identifier: MIT
#include "files.hpp"

namespace sluice::particles::test {
namespace {

class MalformedPly : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedPly, IsRefusedWithPlaceExpectedAndFound) {
    expectRefused(parsePly, GetParam());
}

constexpr std::string_view kXyz = "property float x\nproperty float y\nproperty float z\n";

/// Header lines between the format and end_header, then the body.
File ascii(std::string_view header, std::string_view body) {
    return text(std::string("ply\nformat ascii 1.0\n").append(header).append("end_header\n").append(body));
}

File vertices(std::string_view count, std::string_view body) {
    return ascii(std::string("element vertex ").append(count).append("\n").append(kXyz), body);
}

File binary(std::string_view header, std::string_view body) {
    return text(
        std::string("ply\nformat binary_little_endian 1.0\n").append(header).append("end_header\n").append(body));
}

std::string xyzAnd(std::string_view more, std::string_view count = "1") {
    return std::string("element vertex ").append(count).append("\n").append(kXyz).append(more);
}

/// `count` lines of "WORDS<number>AFTER".
std::string lines(int count, const std::string& words, const std::string& after) {
    std::string all;
    for (int i = 0; i < count; ++i) {
        all += words + std::to_string(i) + after + "\n";
    }
    return all;
}

using namespace std::string_view_literals;

INSTANTIATE_TEST_SUITE_P(
    Header, MalformedPly,
    testing::Values(
        Malformed{"Empty", {}, {"at byte 0", "expected 'ply'", "an empty file"}},
        Malformed{"WrongMagic", text("plx\nformat ascii 1.0\n"), {"at byte 0", "expected 'ply' alone", "'plx\\x0afor"}},
        Malformed{
            "MagicOnly", text("ply\n"), {"at byte 4", "expected 'end_header'", "the end of the file", "cut short"}},
        Malformed{"BigEndian",
                  text("ply\nformat binary_big_endian 1.0\nend_header\n"),
                  {"at line 2", "binary_little_endian", "found binary_big_endian", "export it again"}},
        Malformed{
            "UnknownFormat", text("ply\nformat utf8 1.0\nend_header\n"), {"at line 2", "format ascii 1.0", "'utf8'"}},
        Malformed{
            "Version2", text("ply\nformat ascii 2.0\nend_header\n"), {"at line 2", "'format ascii 1.0'", "'2.0'"}},
        Malformed{
            "NoFormat", text("ply\nelement vertex 1\nend_header\n"), {"at line 3", "a 'format' line", "found none"}},
        Malformed{
            "TwoFormats", text("ply\nformat ascii 1.0\nformat ascii 1.0\nend_header\n"), {"at line 3", "'format'"}},
        Malformed{"NoVertexElement",
                  ascii("element face 0\nproperty float x\n", ""),
                  {"at line 5", "an element 'vertex'", "found none"}},
        // Line 3 declares vertex, 4 to 6 its x y z, 7 to 259 another 253 properties.
        Malformed{"TooManyProperties",
                  ascii(xyzAnd(lines(150'000, "property float p", "")), "0 0 0\n"),
                  {"at line 260", "at most 256 properties of an element", "one more", "export the particles alone"}},
        Malformed{"TooManyElements",
                  ascii(lines(150'000, "element e", " 0"), ""),
                  {"at line 259", "at most 256 elements", "one more", "export the particles alone"}},
        Malformed{"NegativeCount", vertices("-1", ""), {"at line 3", "'element NAME COUNT'", "'-1'"}},
        Malformed{"CountNotANumber", vertices("many", ""), {"at line 3", "'element NAME COUNT'", "'many'"}},
        Malformed{"CountBeyond64Bits", vertices("99999999999999999999", ""), {"at line 3", "'99999999999999999999'"}},
        Malformed{"AbsurdCount",
                  vertices("4294967295", "0 0 0\n"),
                  {"at line 3", "at most 268435456 particles", "found 4294967295"}},
        Malformed{"ElementTwice",
                  ascii(xyzAnd("element vertex 2\n"), ""),
                  {"at line 7", "each element once", "'vertex' again"}},
        Malformed{
            "PropertyTwice", ascii(xyzAnd("property float x\n"), ""), {"at line 7", "each property once", "'x' again"}},
        Malformed{"TwoNamesForOneMeaning",
                  ascii(xyzAnd("property float vx\nproperty float velocity_x\n"), ""),
                  {"at line 3", "one of vx and velocity_x", "found both"}},
        Malformed{"PropertyFirst", ascii("property float x\n", ""), {"at line 3", "an element before its properties"}},
        Malformed{"UnknownType",
                  ascii("element vertex 1\nproperty half x\n", ""),
                  {"at line 4", "one of char uchar", "'half'"}},
        Malformed{"NamelessProperty",
                  ascii("element vertex 1\nproperty float\n", ""),
                  {"at line 4", "one name after the type", "''"}},
        Malformed{"FloatListLength",
                  ascii("element face 1\nproperty list float int i\n", ""),
                  {"at line 4", "an integer type for the length", "'float'"}},
        Malformed{"UnknownKeyword", ascii("elephant vertex 1\n", ""), {"at line 3", "element, property", "'elephant'"}},
        Malformed{"NoZ",
                  ascii("element vertex 1\nproperty float x\nproperty float y\n", "1 2\n"),
                  {"at line 3", "x, y and z", "'x y'"}},
        Malformed{"HalfAVelocity",
                  ascii(xyzAnd("property float vx\n"), "1 2 3 4\n"),
                  {"at line 3", "vx, vy and vz together", "'x y z vx'"}},
        Malformed{"HalfAColour",
                  ascii(xyzAnd("property uchar red\nproperty uchar blue\n"), "1 2 3 4 5\n"),
                  {"at line 3", "red, green and blue together"}},
        Malformed{"SignedColour",
                  ascii(xyzAnd("property int red\nproperty int green\nproperty int blue\n"), "1 2 3 4 5 6\n"),
                  {"at line 3", "colours as uchar, ushort, float or double", "found int red"}},
        Malformed{
            "ListForX",
            ascii("element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z\n", "1 1 2 3\n"),
            {"at line 3", "a number per vertex for 'x'", "found a list"}},
        Malformed{"InfoRadiusZero",
                  ascii(std::string("obj_info radius 0\n").append(xyzAnd("")), "1 2 3\n"),
                  {"at line 3", "particle radius", "found 0"}},
        Malformed{"InfoRadiusNotANumber",
                  ascii(std::string("obj_info radius big\n").append(xyzAnd("")), "1 2 3\n"),
                  {"at line 3", "a number after 'obj_info radius'", "'big'"}}),
    titleOf);

INSTANTIATE_TEST_SUITE_P(
    Ascii, MalformedPly,
    testing::Values(
        Malformed{
            "CutShort", vertices("3", "1 2 3\n4 5 6\n\n"), {"at line 11", "vertex 2 of 3", "the end of the file"}},
        Malformed{"ClaimsTooMuch",
                  vertices("200000000", "1 2 3\n"),
                  {"at line 9", "vertex 1 of 200000000", "the end of the file"}},
        Malformed{
            "TooFewValues", vertices("1", "1 2\n"), {"at line 8", "a number (float) for z", "the end of the line"}},
        Malformed{
            "TooManyValues", vertices("1", "1 2 3 4\n"), {"at line 8", "the end of the line after vertex 0", "'4'"}},
        Malformed{"NotANumber", vertices("1", "1 two 3\n"), {"at line 8", "a number (float) for y", "'two'"}},
        Malformed{"NumberWithTail", vertices("1", "1 2x 3\n"), {"at line 8", "a number (float) for y", "'2x'"}},
        Malformed{"HugeFloat", vertices("1", "1 1e60 3\n"), {"at line 8", "a number (float) for y", "'1e60'"}},
        Malformed{"NanPosition",
                  vertices("2", "1 2 3\n1 nan 3\n"),
                  {"at line 9", "the position of particle 1 finite", "(1, nan, 3)"}},
        Malformed{
            "InfinitePosition", vertices("1", "inf 2 3\n"), {"at line 8", "the position of particle 0", "(inf, 2, 3)"}},
        Malformed{"NanVelocity",
                  ascii(xyzAnd("property float vx\nproperty float vy\nproperty float vz\n"), "1 2 3 4 5 nan\n"),
                  {"at line 11", "the velocity of particle 0", "(4, 5, nan)"}},
        Malformed{"NanColour",
                  ascii(xyzAnd("property float red\nproperty float green\nproperty float blue\n"), "1 2 3 nan 5 6\n"),
                  {"at line 11", "the colour of particle 0"}},
        Malformed{"RadiusOfOneVertex",
                  ascii(xyzAnd("property float radius\n", "2"), "1 2 3 0.1\n1 2 3 -1\n"),
                  {"at line 10", "particle radius", "found -1 for particle 1"}},
        Malformed{"TextAfterTheLast",
                  vertices("1", "1 2 3\n\n4 5 6\n"),
                  {"at line 10", "the end of the file after the last element", "'4 5 6'"}},
        Malformed{
            "ListTooShort",
            ascii(std::string("element face 1\nproperty list uchar int i\n").append(xyzAnd("")), "3 1 2\n1 2 3\n"),
            {"at line 10", "a number (int) for i", "the end of the line"}},
        Malformed{
            "ListOfNegativeLength",
            ascii(std::string("element face 1\nproperty list char int i\n").append(xyzAnd("")), "-3 1 2\n1 2 3\n"),
            {"at line 10", "the length of list 'i'", "found -3"}},
        Malformed{
            "ListOfFractionalLength",
            ascii(std::string("element face 1\nproperty list char int i\n").append(xyzAnd("")), "1.5 1 2\n1 2 3\n"),
            {"at line 10", "the length of list 'i'", "found 1.5"}},
        Malformed{"ElementWithoutProperties",
                  ascii(std::string("element air 4000000000\n").append(xyzAnd("")), "1 2 3\n"),
                  {"at line 3", "properties for element 'air'", "found none"}}),
    titleOf);

INSTANTIATE_TEST_SUITE_P(
    Binary, MalformedPly,
    testing::Values(
        Malformed{"CutShort",
                  binary(xyzAnd("", "2"), "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"sv),
                  {"at byte 115", "2 of element 'vertex', at least 12 bytes each", "15 bytes to the end", "cut short"}},
        Malformed{"Trailing",
                  binary(xyzAnd(""), "\0\0\0\0\0\0\0\0\0\0\0\0\n"sv),
                  {"at byte 127", "the end of the file after the last element", "1 more bytes"}},
        Malformed{"NanPosition",
                  binary(xyzAnd(""), "\0\0\0\0\0\0\xC0\x7F\0\0\0\0"sv),
                  {"at byte 115", "the position of particle 0 finite", "(0, nan, 0)"}},
        Malformed{"ListRunsOut",
                  binary(std::string("element face 1\nproperty list uint double i\n").append(xyzAnd("", "0")),
                         "\xFF\xFF\xFF\xFF\1\2"sv),
                  {"at byte 158", "a list 'i' of 4294967295 values, 34359738360 bytes", "2 bytes to the end"}},
        Malformed{"NegativeList",
                  binary(std::string("element face 1\nproperty list char int i\n").append(xyzAnd("", "0")), "\xFF"sv),
                  {"at byte 155", "the length of list 'i'", "found -1"}},
        Malformed{"FacesAfterwardsRunOut",
                  binary(xyzAnd("element face 2\nproperty list uchar int i\n"), "\0\0\0\0\0\0\0\0\0\0\0\0\0"sv),
                  {"2 of element 'face', at least 1 bytes each", "1 bytes to the end"}},
        Malformed{"ValueRunsOutInMixedElement",
                  binary(std::string("element face 1\nproperty list uchar uchar i\nproperty int id\n")
                             .append(xyzAnd("", "0")),
                         "\x01\x01\0\0\0"sv),
                  {"4 bytes for id of face 0", "3 bytes to the end"}}),
    titleOf);

}  // namespace
}  // namespace sluice::particles::test
