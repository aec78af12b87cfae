// SPDX-License-Identifier: MIT
// A diagnosis for Perfetto.
#pragma once

#include <string>

#include "diagnose/diagnosis.hpp"

namespace sluice::cli {

/// Chrome trace JSON (the "Trace Event Format" document, 2016): one track per actor in the order of their declaration,
/// a slice per event at the times of the schedule, an arrow from each signal to each wait that it satisfied, and an
/// instant event per finding on the track at which it showed.
[[nodiscard]] std::string diagnosisTrace(const Diagnosis& diagnosis);

}  // namespace sluice::cli
