// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <map>

#include "screen/gl_guards.hpp"
#include "sluice/host_gl/state_snapshot.hpp"
#include "state/writer.hpp"

namespace sluice::host {

StateSnapshot takeStateSnapshot() {
    clearGlErrors();
    StateSnapshot snapshot;
    state::Writer writer(snapshot);
    state::writeTables(writer);
    state::writeOutputs(writer);
    state::writeFixedFunction(writer);
    state::writeTextureUnits(writer);
    state::writeVertexArrays(writer);
    state::writeBufferBindings(writer);
    return snapshot;
}

std::vector<std::string> differences(const StateSnapshot& before, const StateSnapshot& after) {
    std::map<std::string, std::string> remaining(after.begin(), after.end());
    std::vector<std::string> lines;
    for (const auto& [name, value] : before) {
        const auto found = remaining.find(name);
        if (found == remaining.end()) {
            lines.push_back(fmt::format("{}: {} -> (not queried)", name, value));
            continue;
        }
        if (found->second != value) {
            lines.push_back(fmt::format("{}: {} -> {}", name, value, found->second));
        }
        remaining.erase(found);
    }
    for (const auto& [name, value] : remaining) {
        lines.push_back(fmt::format("{}: (not queried) -> {}", name, value));
    }
    return lines;
}

}  // namespace sluice::host
