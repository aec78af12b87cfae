// SPDX-License-Identifier: MIT
// Files built byte by byte, and comparisons of particle sets.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "bytes.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::particles::test {

using File = std::vector<std::byte>;

inline File text(std::string_view characters) {
    File file;
    appendText(file, characters);
    return file;
}

/// A .pos file with the count as claimed and the coordinates as given.
inline File pos(std::uint32_t count, float radius, std::initializer_list<float> coordinates) {
    File file;
    appendLittle(file, count);
    appendLittle(file, radius);
    for (const float value : coordinates) {
        appendLittle(file, value);
    }
    return file;
}

/// The nine numbers of a classic bgeo header after 'BgeoV'.
struct BgeoHeader {
    std::uint32_t version = 5;
    std::uint32_t points = 0;
    std::uint32_t primitives = 0;
    std::uint32_t point_groups = 0;
    std::uint32_t primitive_groups = 0;
    std::uint32_t point_attributes = 0;
    std::uint32_t vertex_attributes = 0;
    std::uint32_t primitive_attributes = 0;
    std::uint32_t detail_attributes = 0;
};

inline File bgeo(const BgeoHeader& header) {
    File file = text("BgeoV");
    for (const std::uint32_t number :
         {header.version, header.points, header.primitives, header.point_groups, header.primitive_groups,
          header.point_attributes, header.vertex_attributes, header.primitive_attributes, header.detail_attributes}) {
        appendBig(file, number);
    }
    return file;
}

inline void appendString(File& file, std::string_view name) {
    appendBig(file, static_cast<std::uint16_t>(name.size()));
    appendText(file, name);
}

/// The definition of an attribute of floats, ints or vectors with defaults of 0.
inline void appendDefinition(File& file, std::string_view name, std::uint16_t size, std::uint32_t type) {
    appendString(file, name);
    appendBig(file, size);
    appendBig(file, type);
    for (std::uint16_t i = 0; i < size; ++i) {
        appendBig(file, std::uint32_t{0});
    }
}

inline void appendFloats(File& file, std::initializer_list<float> values) {
    for (const float value : values) {
        appendBig(file, value);
    }
}

/// Bit for bit: 0 and -0 differ.
inline bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

/// A folder that goes away with its test.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        static std::atomic<int> number{0};
        path_ = std::filesystem::temp_directory_path() /
                ("sluice-particles-" + std::to_string(getpid()) + "-" + std::to_string(number.fetch_add(1)));
        std::filesystem::create_directories(path_);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    TemporaryFolder(TemporaryFolder&&) = delete;
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

inline void write(const std::filesystem::path& path, const File& file) {
    std::FILE* out = std::fopen(path.c_str(), "wb");
    ASSERT_NE(out, nullptr) << path;
    if (!file.empty()) {  // an empty vector's data() may be null, which fwrite must not get
        EXPECT_EQ(std::fwrite(file.data(), 1, file.size(), out), file.size());
    }
    EXPECT_EQ(std::fclose(out), 0);
}

/// One way in which a file can be wrong, and parts that the message must hold.
struct Malformed {
    std::string title;
    File file;
    std::vector<std::string> parts;
};

inline void PrintTo(const Malformed& row, std::ostream* out) {
    *out << row.title;
}

inline std::string titleOf(const testing::TestParamInfo<Malformed>& info) {
    return info.param.title;
}

using Parser = Result<ParticleSet> (*)(std::span<const std::byte>, const std::string&);

inline void expectRefused(Parser parse, const Malformed& row) {
    const Result<ParticleSet> result = parse(row.file, "dir/bad.file");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    const std::string message = result.error().message();
    EXPECT_THAT(message, testing::StartsWith("dir/bad.file: at "));
    for (const std::string& part : row.parts) {
        EXPECT_THAT(message, testing::HasSubstr(part));
    }
}

}  // namespace sluice::particles::test
