// SPDX-License-Identifier: MIT
// What was seen in the program, as a JSON document (docs/inject.md has the keys).
#pragma once

#include <string>
#include <vector>

#include "payload/session.hpp"

namespace sluice::inject {

/// One context, as an object; on the thread that draws with it.
[[nodiscard]] std::string contextText(Session& session);
/// The whole, of such texts.
[[nodiscard]] std::string reportText(const Payload& payload, const std::vector<std::string>& contexts,
                                     std::uint64_t other_drawables);
/// Written beside its place and renamed: a reader never finds half of it.
void writeReport(const std::string& folder, const std::string& text);

}  // namespace sluice::inject
