// SPDX-License-Identifier: MIT
// All the files of a render, looked at before any work.
#pragma once

#include "app/options.hpp"
#include "app/output_folders.hpp"
#include "app/render_inputs.hpp"
#include "sluice/result.hpp"

namespace sluice::cli {

/// Refuses an output that is also an input or another output. Ends early, with success, when interrupted().
[[nodiscard]] Status checkRoles(const RenderOptions& options, const RenderInputs& inputs);

/// Makes and tries the place of every output. Ends early, with success, when interrupted().
[[nodiscard]] Status prepareOutputs(OutputFolders& folders, const RenderOptions& options, scene::FrameRange frames);

}  // namespace sluice::cli
