// SPDX-License-Identifier: MIT
// sluice inject: fluid in a program that knows nothing of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "payload/settings.hpp"
#include "sluice/result.hpp"

namespace CLI {
class App;
}

namespace sluice::cli {

struct InjectOptions {
    std::string scene, profile, plugin;
    std::string report_to;  ///< a file; empty: stdout
    bool report = false, json = false, off = false, children = false, same_process = false;
    double step_s = 0.0;
    std::vector<std::string> command;
};

void addInjectCommand(CLI::App& app, InjectOptions& options, std::function<int()>& run);
int inject(const InjectOptions& options);

/// Lays the profile's rules over `settings`. docs/inject.md has the schema.
[[nodiscard]] Status readProfile(const std::string& path, inject::Settings& settings);
/// Takes water, look and sky from a scene.
[[nodiscard]] Status readInjectedScene(const std::string& path, inject::Settings& settings);
/// The reports that the payload left in `folder`, one per process, as text or as one JSON list.
[[nodiscard]] std::string injectReport(const std::string& folder, bool json);

}  // namespace sluice::cli
