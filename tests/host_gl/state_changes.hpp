// SPDX-License-Identifier: MIT
// Single state changes, and the one line of a snapshot that each must move.
#pragma once

#include <epoxy/gl.h>

#include <ostream>
#include <span>
#include <string_view>

#include "spare_objects.hpp"

namespace sluice::host::test {

struct StateChange {
    std::string_view test_name;
    std::string_view line;  ///< the name of the state that the snapshot must report
    void (*make)(const SpareObjects&);
};
/// For GoogleTest's messages.
inline void PrintTo(const StateChange& change, std::ostream* out) {
    *out << change.line;
}

[[nodiscard]] std::span<const StateChange> stateChanges();

}  // namespace sluice::host::test
