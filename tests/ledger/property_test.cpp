// SPDX-License-Identifier: MIT
// Random programs: silence about those in order, and about broken ones the same opinion as the brute-force oracle.
#include <random>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "random_program.hpp"
#include "script.hpp"

namespace sluice::ledger::test {
namespace {

Choices choices(std::size_t most) {
    const auto length = *rc::gen::inRange<std::size_t>(20, most);
    return Choices(*rc::gen::container<std::vector<std::uint8_t>>(length, rc::gen::arbitrary<std::uint8_t>()));
}

bool isRace(FindingKind kind) {
    return kind == FindingKind::ReadAfterWrite || kind == FindingKind::WriteAfterRead ||
           kind == FindingKind::WriteAfterWrite;
}

std::set<ObjectId> resources(const Ledger& ledger, bool races) {
    std::set<ObjectId> all;
    for (const Finding& finding : ledger.findings()) {
        if (races ? isRace(finding.kind) : finding.kind == FindingKind::NotListed) {
            all.insert(finding.second.object);
        }
    }
    return all;
}

RC_GTEST_PROP(LedgerProperty, ProgramsInOrderAreSilentInEveryLog, ()) {
    Choices some = choices(600);
    const Program program = wellOrdered(some, *rc::gen::arbitrary<bool>());
    const auto verdict = judge(program);
    RC_ASSERT(verdict.racing.empty());
    RC_ASSERT(verdict.unlisted.empty());
    RC_ASSERT(verdict.stuck == 0U);
    for (int i = 0; i < 4; ++i) {
        Ledger ledger = replay(program, interleave(program, *rc::gen::arbitrary<std::uint32_t>()));
        ledger.finish(End::Closed);
        if (!ledger.findings().empty()) {
            RC_LOG(describe(program));
        }
        RC_ASSERT(tell(ledger) == std::string());
        RC_ASSERT(ledger.blocked().empty());
    }
}

RC_GTEST_PROP(LedgerProperty, BrokenProgramsAreJudgedAsTheOracleDoes, ()) {
    Choices some = choices(400);
    Program program = wellOrdered(some, true);
    Choices how = choices(40);
    RC_LOG(mutate(program, how));
    const auto verdict = judge(program);
    RC_CLASSIFY(!verdict.racing.empty(), "race");
    RC_CLASSIFY(!verdict.unlisted.empty(), "not listed");
    RC_CLASSIFY(verdict.stuck != 0, "stuck");
    for (int i = 0; i < 4; ++i) {
        Ledger ledger = replay(program, interleave(program, *rc::gen::arbitrary<std::uint32_t>()), i < 2 ? 2 : 64);
        const bool blocked = !ledger.blocked().empty();
        ledger.finish(End::Closed);
        RC_LOG(tell(ledger));
        RC_ASSERT(resources(ledger, true) == verdict.racing);
        for (const ObjectId r : resources(ledger, false)) {
            RC_ASSERT(verdict.unlisted.count(r) + verdict.racing.count(r) == 1U);
        }
        for (const ObjectId r : verdict.unlisted) {
            RC_ASSERT(resources(ledger, false).count(r) == 1U);
        }
        RC_ASSERT(blocked == (verdict.stuck != 0));
        if (blocked) {
            RC_ASSERT(!ledger.findings().empty());
        }
    }
}

/// Longer programs, so that many signals are forgotten; a fault somewhere.
RC_GTEST_PROP(LedgerProperty, ForgettingSignalsChangesNoVerdict, ()) {
    std::vector<std::uint8_t> bytes(1500);
    std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
    for (auto& byte : bytes) {
        byte = static_cast<std::uint8_t>(random());
    }
    Choices some(std::move(bytes));
    Program program = wellOrdered(some, true);
    Choices how = choices(40);
    RC_LOG(mutate(program, how));
    const auto log = interleave(program, static_cast<std::uint32_t>(random()));
    Ledger forgetful = replay(program, log, 2);
    Ledger keeping = replay(program, log, SIZE_MAX);
    RC_CLASSIFY(forgetful.memoryBytes() < keeping.memoryBytes(), "forgot something");
    forgetful.finish(End::Closed);
    keeping.finish(End::Closed);
    RC_ASSERT(kinds(forgetful) == kinds(keeping));
    for (std::size_t i = 0; i < keeping.findings().size(); ++i) {
        RC_ASSERT(forgetful.findings()[i].first.sequence == keeping.findings()[i].first.sequence);
        RC_ASSERT(forgetful.findings()[i].second.sequence == keeping.findings()[i].second.sequence);
        RC_ASSERT(forgetful.findings()[i].count == keeping.findings()[i].count);
    }
}

}  // namespace
}  // namespace sluice::ledger::test
