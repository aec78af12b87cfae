// SPDX-License-Identifier: MIT
#include "sluice/host_gl/state_snapshot.hpp"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "gl_test.hpp"
#include "state_changes.hpp"

namespace sluice::host::test {
namespace {

using StateSnapshotTest = GlTest;

class SingleStateChange : public GlTest, public ::testing::WithParamInterface<StateChange> {};

TEST_P(SingleStateChange, MovesExactlyItsOwnLine) {
    const SpareObjects objects;
    ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    const StateSnapshot before = takeStateSnapshot();
    GetParam().make(objects);
    ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "the change itself failed";
    const std::vector<std::string> lines = differences(before, takeStateSnapshot());
    ASSERT_THAT(lines, ::testing::SizeIs(1));
    EXPECT_THAT(lines.front(), ::testing::StartsWith(std::string(GetParam().line) + ": "));
    EXPECT_THAT(lines.front(), ::testing::HasSubstr(" -> "));
}

INSTANTIATE_TEST_SUITE_P(StateSnapshot, SingleStateChange,
                         ::testing::ValuesIn(stateChanges().begin(), stateChanges().end()),
                         [](const auto& parameter) { return std::string(parameter.param.test_name); });

TEST_F(StateSnapshotTest, TakingOneChangesNothingAndRaisesNoError) {
    const StateSnapshot first = takeStateSnapshot();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    const StateSnapshot second = takeStateSnapshot();
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    EXPECT_THAT(differences(first, second), ::testing::IsEmpty());
    EXPECT_EQ(first, second);
}

TEST_F(StateSnapshotTest, NamesAreUniqueSoThatNoLineCanHideAnother) {
    std::set<std::string> names;
    for (const auto& [name, value] : takeStateSnapshot()) {
        EXPECT_TRUE(names.insert(name).second) << name;
    }
    EXPECT_GT(names.size(), 1000U);
}

TEST_F(StateSnapshotTest, EveryQueryIsAnsweredByThisDriver) {
    for (const auto& [name, value] : takeStateSnapshot()) {
        EXPECT_NE(value, "unavailable") << name;
    }
}

TEST_F(StateSnapshotTest, DefaultsAreThoseOfTheSpecification) {
    std::set<std::pair<std::string, std::string>> found;
    for (const auto& entry : takeStateSnapshot()) {
        found.insert(entry);
    }
    EXPECT_TRUE(found.contains({"GL_DITHER", "1"}));
    EXPECT_TRUE(found.contains({"GL_DEPTH_TEST", "0"}));
    EXPECT_TRUE(found.contains({"GL_FOG_DENSITY", "1"}));
    EXPECT_TRUE(found.contains({"GL_DEPTH_FUNC", "0x0201"}));
    EXPECT_TRUE(found.contains({"GL_LIGHT0.GL_DIFFUSE", "1 1 1 1"}));
    EXPECT_TRUE(found.contains({"GL_LIGHT1.GL_DIFFUSE", "0 0 0 1"}));
    EXPECT_TRUE(found.contains({"unit 0.GL_TEXTURE_GEN_S.object plane", "1 0 0 0"}));
    EXPECT_TRUE(found.contains({"GL_UNPACK_ALIGNMENT", "4"}));
}

TEST(StateDifferences, ReportsChangedMissingAndNewEntries) {
    const StateSnapshot before{{"GL_BLEND", "0"}, {"GL_FOG", "1"}, {"gone", "x"}};
    const StateSnapshot after{{"GL_BLEND", "1"}, {"GL_FOG", "1"}, {"new", "y"}};
    EXPECT_THAT(differences(before, after),
                ::testing::ElementsAre("GL_BLEND: 0 -> 1", "gone: x -> (not queried)", "new: (not queried) -> y"));
}

}  // namespace
}  // namespace sluice::host::test
