// SPDX-License-Identifier: MIT
// For each kind of finding a program that has that fault and no other, and its twin without.
#pragma once

#include <functional>
#include <vector>

#include "script.hpp"

namespace sluice::ledger::test {

struct Case {
    FindingKind kind;
    std::function<void(Script&)> faulty, clean;
    End end = End::Closed;
    /// What is found besides: racing-but-fine needs a race to be lucky about.
    std::vector<FindingKind> with = {};
};

[[nodiscard]] std::vector<Case> orderCases();
[[nodiscard]] std::vector<Case> stateCases();
[[nodiscard]] std::vector<Case> costCases();
[[nodiscard]] std::vector<Case> allCases();

}  // namespace sluice::ledger::test
