// SPDX-License-Identifier: MIT
#include <sys/stat.h>

#include "files.hpp"

namespace sluice::particles::test {
namespace {

using testing::HasSubstr;

ParticleSet someSet() {
    return {0.025F, {1, 2, 3, -4.5F, 0.1F, 1e-20F}, {0.5F, -1, 2, 3, 4, 5}, {0, 0.25F, 1, 0.125F, 0.75F, 1}};
}

std::size_t entries(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

class SaveAndLoad : public testing::TestWithParam<const char*> {};

TEST_P(SaveAndLoad, GivesTheSameSet) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / GetParam();
    const Status saved = save(path, someSet());
    ASSERT_TRUE(saved.ok()) << saved.error().message();
    EXPECT_EQ(entries(folder.path()), 1U) << "the temporary file stayed behind";
    const Result<ParticleSet> set = load(path);
    ASSERT_TRUE(set.ok()) << set.error().message();
    const bool whole = path.extension() != ".pos" && path.extension() != ".POS";
    EXPECT_EQ(set.value().radius, someSet().radius);
    EXPECT_TRUE(sameBits(set.value().position, someSet().position));
    EXPECT_TRUE(sameBits(set.value().velocity, whole ? someSet().velocity : std::vector<float>{}));
    EXPECT_TRUE(sameBits(set.value().colour, whole ? someSet().colour : std::vector<float>{}));
}

INSTANTIATE_TEST_SUITE_P(Endings, SaveAndLoad,
                         testing::Values("a.pos", "A.POS", "a.ply", "a.bgeo", "a.bgeo.gz", "a.bhclassic",
                                         "a.bhclassic.gz"));

TEST(Save, GzipIsGzipAndPlainIsPlain) {
    const TemporaryFolder folder;
    ASSERT_TRUE(save(folder / "a.bgeo", someSet()).ok());
    ASSERT_TRUE(save(folder / "a.bgeo.gz", someSet()).ok());
    const auto first = [](const std::filesystem::path& path) {
        std::FILE* file = std::fopen(path.c_str(), "rb");
        const int byte = std::fgetc(file);
        std::fclose(file);
        return byte;
    };
    EXPECT_EQ(first(folder / "a.bgeo"), 'B');
    EXPECT_EQ(first(folder / "a.bgeo.gz"), 0x1F);
}

TEST(Save, ReplacesAFileWhole) {
    const TemporaryFolder folder;
    write(folder / "a.pos", text(std::string(5000, 'x')));
    ASSERT_TRUE(save(folder / "a.pos", someSet()).ok());
    EXPECT_EQ(std::filesystem::file_size(folder / "a.pos"), 8U + 24U);
    EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(Save, FailureLeavesTheOldFileAndNoTemporary) {
    const TemporaryFolder folder;
    write(folder / "a.pos", text("old"));
    ParticleSet bad = someSet();
    bad.radius = 0.0F;
    const Status status = save(folder / "a.pos", bad);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(std::filesystem::file_size(folder / "a.pos"), 3U);
    EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(Save, IntoAMissingFolderTellsWhy) {
    const TemporaryFolder folder;
    const Status status = save(folder / "none/a.pos", someSet());
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(status.error().message(), HasSubstr("none/a.pos: cannot be written: No such file or directory"));
    EXPECT_EQ(entries(folder.path()), 0U);
}

TEST(Save, ThroughAFileTellsWhy) {
    const TemporaryFolder folder;
    write(folder / "file", text("x"));
    const Status status = save(folder / "file/a.ply", someSet());
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message(), HasSubstr("cannot be written: Not a directory"));
    EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(Save, OntoAFolderRemovesItsTemporary) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a.bgeo");
    const Status status = save(folder / "a.bgeo", someSet());
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message(), HasSubstr("cannot be written: Is a directory"));
    EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(Save, UnknownEndingNamesTheKnownOnes) {
    const Status status = save("a.obj", someSet());
    ASSERT_FALSE(status.ok());
    EXPECT_THAT(status.error().message(), HasSubstr("a.obj: expected the ending .pos, .ply, .bgeo, .bgeo.gz"));
}

TEST(Load, MissingFileTellsErrno) {
    const Result<ParticleSet> set = load("/nowhere/a.pos");
    ASSERT_FALSE(set.ok());
    EXPECT_EQ(set.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(set.error().message(), HasSubstr("/nowhere/a.pos: cannot be read: No such file or directory"));
}

TEST(Load, FolderTellsErrno) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a.ply");
    const Result<ParticleSet> set = load(folder / "a.ply");
    ASSERT_FALSE(set.ok());
    EXPECT_THAT(set.error().message(), HasSubstr("cannot be read: Is a directory"));
}

TEST(Load, APipeIsRefusedWithoutWaitingForIt) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "a.pos";
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    const Result<ParticleSet> set = load(path);
    ASSERT_FALSE(set.ok());
    EXPECT_THAT(set.error().message(), HasSubstr(path.string()));
    EXPECT_THAT(set.error().message(), HasSubstr("expected a regular file, found a pipe"));
}

TEST(Load, ADeviceIsRefused) {
    const TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/zero", folder / "a.pos");
    const Result<ParticleSet> set = load(folder / "a.pos");
    ASSERT_FALSE(set.ok());
    EXPECT_THAT(set.error().message(), HasSubstr("expected a regular file, found a device"));
}

TEST(Load, ATooLargeFileIsRefusedUnread) {
    const TemporaryFolder folder;
    ASSERT_TRUE(save(folder / "a.pos", someSet()).ok());
    std::filesystem::resize_file(folder / "a.pos", kMaxFileBytes + 1);  // sparse: takes no room
    const Result<ParticleSet> set = load(folder / "a.pos");
    ASSERT_FALSE(set.ok());
    EXPECT_THAT(set.error().message(), HasSubstr("expected at most 17179869184 bytes, found 17179869185"));
}

TEST(Load, UnknownEndingNamesTheKnownOnes) {
    const Result<ParticleSet> set = load("/nowhere/a.vtk");
    ASSERT_FALSE(set.ok());
    EXPECT_THAT(set.error().message(), HasSubstr("a.vtk: expected the ending .pos, .ply, .bgeo, .bgeo.gz"));
}

TEST(Load, ErrorsOfTheParsersNameThePath) {
    const TemporaryFolder folder;
    write(folder / "empty.pos", {});
    const Result<ParticleSet> set = load(folder / "empty.pos");
    ASSERT_FALSE(set.ok());
    EXPECT_THAT(set.error().message(), testing::StartsWith((folder / "empty.pos").string() + ": at byte 0: expected"));
}

TEST(Load, ASetWithoutRadiusTakesTheDefaultOrTellsHowToGiveOne) {
    const TemporaryFolder folder;
    ParticleSet set = someSet();
    set.radius = 0.0F;
    ASSERT_TRUE(save(folder / "a.ply", set).ok());
    const Result<ParticleSet> with = load(folder / "a.ply", 0.5F);
    ASSERT_TRUE(with.ok());
    EXPECT_EQ(with.value().radius, 0.5F);
    EXPECT_TRUE(with.value().radius_given);
    const Result<ParticleSet> without = load(folder / "a.ply", 0.0F, "write it on the wall");
    ASSERT_FALSE(without.ok());
    EXPECT_THAT(without.error().message(), HasSubstr("holds no particle radius (write it on the wall)"));
    const Result<ParticleSet> absurd = load(folder / "a.ply", 5000.0F);
    ASSERT_FALSE(absurd.ok());
    EXPECT_THAT(absurd.error().message(), HasSubstr("the one given is 5000, not from 1e-06 to 1000 m"));
    ASSERT_TRUE(save(folder / "a.bgeo", someSet()).ok());
    EXPECT_EQ(load(folder / "a.bgeo", 0.5F).value().radius, someSet().radius) << "the file's own radius wins";
    EXPECT_FALSE(load(folder / "a.bgeo", 0.5F).value().radius_given);
}

}  // namespace
}  // namespace sluice::particles::test
