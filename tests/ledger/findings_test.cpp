// SPDX-License-Identifier: MIT
// Each kind of finding: its program yields it and nothing else, its twin yields nothing; and the table of the
// documents.
#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cases.hpp"

namespace sluice::ledger::test {
namespace {

class FindingCase : public testing::TestWithParam<std::size_t> {};

TEST_P(FindingCase, FaultIsFoundAndNothingElse) {
    const Case one = allCases().at(GetParam());
    Script script;
    one.faulty(script);
    script.ledger.finish(one.end);
    auto expected = one.with;
    expected.push_back(one.kind);
    EXPECT_EQ(kinds(script.ledger), expected) << tell(script.ledger);
    for (const Finding& finding : script.ledger.findings()) {
        EXPECT_FALSE(finding.sentence.empty());
        EXPECT_FALSE(finding.remedy.empty());
        EXPECT_EQ(finding.count, 1U);
        EXPECT_EQ(finding.sentence.find("  "), std::string::npos) << finding.sentence;
        EXPECT_EQ(finding.sentence.back(), '.') << finding.sentence;
    }
    RecordProperty("told", tell(script.ledger));
}

TEST_P(FindingCase, TwinIsClean) {
    const Case one = allCases().at(GetParam());
    Script script;
    one.clean(script);
    script.ledger.finish(one.end);
    EXPECT_EQ(kinds(script.ledger), std::vector<FindingKind>{}) << tell(script.ledger);
    EXPECT_TRUE(script.ledger.blocked().empty());
}

INSTANTIATE_TEST_SUITE_P(Ledger, FindingCase, testing::Range<std::size_t>(0, allCases().size()),
                         [](const auto& parameter) {
                             std::string name(findingInfo(allCases().at(parameter.param).kind).id);
                             for (char& c : name) {
                                 c = c == '-' ? '_' : c;
                             }
                             return name + "_" + std::to_string(parameter.param);
                         });

TEST(LedgerFindings, EveryKindHasAProgramAndATwin) {
    std::set<FindingKind> covered;
    for (const Case& one : allCases()) {
        covered.insert(one.kind);
    }
    for (std::size_t i = 0; i < kFindingKindCount; ++i) {
        const auto kind = static_cast<FindingKind>(i);
        EXPECT_EQ(covered.count(kind), 1U) << findingInfo(kind).id << " has no program that shows it";
    }
}

TEST(LedgerFindings, IdsAreUniqueAndFound) {
    std::set<std::string_view> ids;
    for (std::size_t i = 0; i < kFindingKindCount; ++i) {
        const auto& info = findingInfo(static_cast<FindingKind>(i));
        EXPECT_TRUE(ids.insert(info.id).second) << info.id;
        EXPECT_EQ(findFindingInfo(info.id), &info);
    }
    EXPECT_EQ(findFindingInfo("no-such-finding"), nullptr);
}

/// docs/ledger.md has one row per kind: | `id` | severity | meaning | remedy |
TEST(LedgerFindings, DocumentHasTheTable) {
    std::ifstream file(SLUICE_LEDGER_DOCUMENT);
    ASSERT_TRUE(file) << SLUICE_LEDGER_DOCUMENT;
    std::vector<std::string> rows;
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("| `", 0) == 0) {
            rows.push_back(line);
        }
    }
    std::vector<std::string> expected;
    for (std::size_t i = 0; i < kFindingKindCount; ++i) {
        const auto& info = findingInfo(static_cast<FindingKind>(i));
        std::ostringstream row;
        row << "| `" << info.id << "` | " << toString(info.severity) << " | " << info.meaning << " | " << info.remedy
            << " |";
        expected.push_back(row.str());
    }
    EXPECT_EQ(rows, expected);
}

}  // namespace
}  // namespace sluice::ledger::test
