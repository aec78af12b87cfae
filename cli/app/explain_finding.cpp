// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/exit_codes.hpp"
#include "app/ledger_commands.hpp"
#include "app/log.hpp"
#include "report/table.hpp"
#include "scene/nearest.hpp"
#include "sluice/ledger/finding.hpp"

namespace sluice::cli {
namespace {

using Json = nlohmann::ordered_json;

Json infoJson(const ledger::FindingInfo& info) {
    return {{"id", info.id},
            {"severity", toString(info.severity)},
            {"title", info.title},
            {"meaning", info.meaning},
            {"remedy", info.remedy}};
}

void printAll(bool json) {
    Json list = Json::array();
    std::vector<std::vector<std::string>> rows{{"finding", "severity", "what"}};
    for (std::size_t i = 0; i < ledger::kFindingKindCount; ++i) {
        const ledger::FindingInfo& info = ledger::findingInfo(static_cast<ledger::FindingKind>(i));
        list.push_back(infoJson(info));
        rows.push_back({std::string(info.id), std::string(toString(info.severity)), std::string(info.title)});
    }
    fmt::print("{}", json ? list.dump(2) + "\n" : formatTable(rows, {}));
}

}  // namespace

int explainFinding(const ExplainFindingOptions& options) {
    if (options.id.empty()) {
        printAll(options.json);
        return kExitOk;
    }
    const ledger::FindingInfo* info = ledger::findFindingInfo(options.id);
    if (info == nullptr) {
        std::vector<std::string_view> known;
        for (std::size_t i = 0; i < ledger::kFindingKindCount; ++i) {
            known.push_back(ledger::findingInfo(static_cast<ledger::FindingKind>(i)).id);
        }
        const std::string_view guess = scene::nearest(options.id, known);
        logError({SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("'{}'", options.id),
                  fmt::format("no kind of finding has that id{}",
                              guess.empty() ? "" : fmt::format("; the nearest is '{}'", guess)),
                  "sluice explain-finding lists them all"});
        return kExitUsage;
    }
    if (options.json) {
        fmt::print("{}\n", infoJson(*info).dump(2));
    } else {
        fmt::print("{} ({}): {}\n\n{}\n\nremedy: {}\n", info->id, toString(info->severity), info->title, info->meaning,
                   info->remedy);
    }
    return kExitOk;
}

}  // namespace sluice::cli
