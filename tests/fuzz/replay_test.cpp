// SPDX-License-Identifier: MIT
// Every file of the corpus through its target, in every build: what fuzzing once found stays found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "targets.hpp"

namespace sluice::fuzz {
namespace {

using Path = std::filesystem::path;

std::vector<Path> corpus() {
    std::vector<Path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(SLUICE_FUZZ_CORPUS)) {
        if (entry.is_regular_file()) {
            files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
    return files;
}

std::vector<std::byte> read(const Path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> characters{std::istreambuf_iterator<char>(file), {}};
    const auto bytes = std::as_bytes(std::span(characters));
    return {bytes.begin(), bytes.end()};
}

class Replay : public testing::TestWithParam<Path> {};

// A broken promise aborts the program, so that a pass is the return itself.
TEST_P(Replay, KeepsEveryPromise) {
    const Target target = targetNamed(GetParam().parent_path().filename().string());
    ASSERT_NE(target, nullptr) << "no target is called like the folder of " << GetParam();
    target(read(GetParam()));
}

std::string nameOf(const testing::TestParamInfo<Path>& file) {
    std::string name = file.param.parent_path().filename().string() + "_" + file.param.filename().string();
    std::ranges::replace_if(
        name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Corpus, Replay, testing::ValuesIn(corpus()), nameOf);

TEST(ReplayCorpus, HoldsSeedsForEveryTarget) {
    std::map<std::string, int> seeds;
    for (const Path& path : corpus()) {
        ++seeds[path.parent_path().filename().string()];
    }
    for (const char* target : {"pos", "ply", "bgeo", "scene", "ledger_log", "isolate"}) {
        EXPECT_GE(seeds[target], 5) << target;
    }
}

TEST(ReplayCorpusDeathTest, ABrokenPromiseIsSeen) {
    // The check of the checks: if abort were lost, every replay would pass.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(breakPromise(), "broken promise: none was kept");
}

}  // namespace
}  // namespace sluice::fuzz
