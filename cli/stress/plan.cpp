// SPDX-License-Identifier: MIT
#include "stress/plan.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sluice/canary.hpp"

namespace sluice::stress {
namespace {

constexpr std::uint32_t kRoundsBetweenChecks = 250;
constexpr std::uint32_t kStormRounds = 12;  ///< between two storms, at most
constexpr std::uint32_t kStormSide = 96;    ///< texels; tiny on purpose, so that edges of tiles are everywhere
/// Of a create-destroy-storm, whose other epochs keep the devices: three times in as few as 150 hand-offs.
constexpr std::uint64_t kEpochsPerEverything = 3;
constexpr std::uint32_t kLeastDelay = 500, kMostDelay = 20'000;  ///< microseconds

template <typename T, std::size_t N>
std::vector<T> chosen(const std::array<Named<T>, N>& names, const std::optional<T>& choice) {
    if (choice) {
        return {*choice};
    }
    std::vector<T> all;
    all.reserve(N);
    for (const Named<T>& one : names) {
        all.push_back(one.value);
    }
    return all;
}

bool isStorm(Pattern pattern) {
    return pattern == Pattern::ResizeStorm || pattern == Pattern::CreateDestroyStorm;
}

Shape shapeOf(Pattern pattern, Chance& chance) {
    switch (pattern) {
        case Pattern::Ring:
            return {chance.between(2, kMaxSets), 1, false};
        case Pattern::WaitBeforeSignal:
            return {chance.between(1, kMaxSets), 1, false};
        case Pattern::FanOut:
            return {1, chance.between(2, kMaxSets), false};
        case Pattern::HostInTheMiddle:
            return {1, 1, true};
        case Pattern::ResizeStorm:
        case Pattern::CreateDestroyStorm:
            return {chance.between(1, 3), 1, false};
        default:
            return {};
    }
}

/// What the user asked for, without what is run through whole.
std::string namedIn(const Options& options) {
    std::string text;
    const auto add = [&text](const char* option, const auto& choice) {
        if (choice) {
            text += fmt::format("{}{} {}", text.empty() ? "" : " ", option, toString(*choice));
        }
    };
    add("--pattern", options.pattern);
    add("--backend", options.backend);
    add("--resource", options.resource);
    add("--topology", options.topology);
    add("--fault", options.fault == Fault::None ? std::nullopt : options.fault);
    return text;
}

/// The host's own thread has waited for OpenGL before it submits: the order of submission then says as much as the
/// queue's wait, and to leave that wait out is no fault.
bool submissionOrders(const Combination& combination) {
    return combination.topology == Topology::OneThread;
}

}  // namespace

std::string whyNot(const Combination& combination) {
    if (combination.backend != Backend::Bridged && combination.topology == Topology::TwoProcesses) {
        return "between two processes values cross in shared memory, which only a bridge can carry on; take bridged";
    }
    if (combination.backend == Backend::Finish && combination.topology == Topology::BridgeThread) {
        return "finish has no bridge: it waits on the host's own thread; take one-thread";
    }
    if (combination.backend == Backend::Finish && combination.pattern == Pattern::WaitBeforeSignal) {
        return "with finish the queue is idle when a submission returns, so none may wait for a later signal; take "
               "bridged";
    }
    if (combination.fault == Fault::WrongLayout && combination.resource == Resource::Buffer) {
        return "a buffer has no layout; take colour, D32F or R32F";
    }
    return {};
}

Result<Matrix> matrixOf(const Options& options) {
    Matrix matrix;
    for (const Fault fault : chosen(kFaults, options.fault)) {
        for (const Pattern pattern : chosen(kPatterns, options.pattern)) {
            for (const Backend backend : chosen(kBackends, options.backend)) {
                for (const Resource resource : chosen(kResources, options.resource)) {
                    for (const Topology topology : chosen(kTopologies, options.topology)) {
                        const Combination one{pattern, backend, resource, topology, fault};
                        std::string why = whyNot(one);
                        if (options.alternations && resource == Resource::R32F) {
                            continue;  // colour of another format
                        }
                        if (why.empty()) {
                            matrix.runs.push_back(one);
                        } else {
                            matrix.skipped.push_back({one, std::move(why)});
                        }
                    }
                }
            }
        }
    }
    if (matrix.runs.empty()) {
        const Skipped& first = matrix.skipped.front();
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, namedIn(options), first.why, ""};
    }
    return matrix;
}

std::uint64_t seedOf(const Combination& combination, std::uint64_t seed) {
    Chance chance(seed);
    std::uint64_t mixed = chance.next();
    for (const auto part :
         {static_cast<std::uint64_t>(combination.pattern), static_cast<std::uint64_t>(combination.backend),
          static_cast<std::uint64_t>(combination.resource), static_cast<std::uint64_t>(combination.topology),
          static_cast<std::uint64_t>(combination.fault)}) {
        mixed = Chance(mixed ^ (part + 1)).next();
    }
    return mixed;
}

Planner::Planner(const Combination& combination, std::uint64_t seed)
    : combination_(combination), chance_(seedOf(combination, seed)), shape_(shapeOf(combination.pattern, chance_)) {}

PlannedFault Planner::fault(std::uint32_t rounds) {
    PlannedFault planned;
    planned.kind = combination_.fault;
    // Every set has been round once before, and goes round twice after: what the fault spoilt is read and spreads.
    planned.round = chance_.between(shape_.sets + 2, rounds - 2 * shape_.sets - 1);
    planned.delay_us = chance_.between(kLeastDelay, kMostDelay);
    const bool vulkan = chance_.between(0, 1) == 1;
    switch (planned.kind) {
        case Fault::SkipWait:
        case Fault::WrongValue:
            planned.side = vulkan && !submissionOrders(combination_) ? Side::Vulkan : Side::Gl;
            break;
        case Fault::EarlyReuse:
            planned.side = combination_.pattern == Pattern::VkToGl ? Side::Vulkan : Side::Gl;
            break;
        case Fault::WrongLayout:
            planned.side = Side::Vulkan;
            break;
        default:
            break;
    }
    return planned;
}

Epoch Planner::next() {
    Epoch epoch;
    epoch.width = kCanaryWidth;
    epoch.height = kCanaryHeight;
    epoch.rounds = kRoundsBetweenChecks;
    const bool storm = isStorm(combination_.pattern);
    if (storm) {
        epoch.rounds = chance_.between(1, kStormRounds);
        epoch.width = chance_.between(1, kStormSide);
        epoch.height = chance_.between(1, kStormSide);
        epoch.rebuild = Rebuild::Resources;
    }
    if (combination_.fault != Fault::None) {
        epoch.rounds = 4 * shape_.sets + chance_.between(8, 24);
        epoch.fault = fault(epoch.rounds);
    }
    if (epochs_ == 0 || (combination_.pattern == Pattern::CreateDestroyStorm && epochs_ % kEpochsPerEverything == 0)) {
        epoch.rebuild = Rebuild::Everything;
    }
    epoch.fresh = epochs_ == 0 || storm || combination_.fault != Fault::None;
    ++epochs_;
    return epoch;
}

std::string commandLine(const Combination& combination, std::uint64_t seed, std::uint64_t handoffs) {
    return fmt::format(
        "sluice stress --pattern {} --backend {} --resource {} --topology {} --fault {} --seed {} --handoffs {}",
        toString(combination.pattern), toString(combination.backend), toString(combination.resource),
        toString(combination.topology), toString(combination.fault), seed, handoffs);
}

}  // namespace sluice::stress
