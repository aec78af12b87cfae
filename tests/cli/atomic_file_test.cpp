// SPDX-License-Identifier: MIT
#include "image/atomic_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace sluice::cli {
namespace {

class AtomicFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(::testing::TempDir()) /
                  (std::string("atomic-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::ptrdiff_t count() const {
        return std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator());
    }
    std::filesystem::path folder_;
};

TEST_F(AtomicFiles, CreateTheirFolderAndAppearOnlyOnCommit) {
    const std::filesystem::path path = folder_ / "deep" / "a.txt";
    ASSERT_TRUE(writeTextFile(path, "old").ok());
    {
        auto file = AtomicFile::create(path);
        ASSERT_TRUE(file.ok());
        std::ofstream(file.value().temporary()) << "new";
        std::ifstream before(path);
        EXPECT_EQ((std::string{std::istreambuf_iterator<char>(before), {}}), "old");
        ASSERT_TRUE(file.value().commit().ok());
    }
    std::ifstream after(path);
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>(after), {}}), "new");
}

TEST_F(AtomicFiles, LeaveNothingWithoutCommit) {
    {
        auto file = AtomicFile::create(folder_ / "a.txt");
        ASSERT_TRUE(file.ok());
        std::ofstream(file.value().temporary()) << "half";
        EXPECT_EQ(count(), 1);
    }
    EXPECT_EQ(count(), 0);
}

TEST_F(AtomicFiles, NameTheFileThatCannotBeWritten) {
    ASSERT_TRUE(writeTextFile(folder_ / "file", "x").ok());
    const auto below = AtomicFile::create(folder_ / "file" / "a.txt");
    ASSERT_FALSE(below.ok());
    EXPECT_NE(below.error().message().find("a.txt"), std::string::npos);
    EXPECT_FALSE(AtomicFile::create(folder_ / "").ok());
}

}  // namespace
}  // namespace sluice::cli
