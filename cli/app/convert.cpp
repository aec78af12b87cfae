// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>

#include "app/commands.hpp"
#include "app/file_roles.hpp"
#include "app/log.hpp"
#include "app/output_folders.hpp"
#include "report/table.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::cli {

int convert(const ConvertOptions& options) {
    FileRoles roles;
    roles.add("the input file", options.input);
    if (const Status status = roles.check("the output file", options.output); !status) {
        logError(status.error());
        return kExitUsage;
    }
    if (const Status status = particles::checkEnding(options.output); !status) {
        logError(status.error());
        return kExitUsage;
    }
    OutputFolders folders;
    if (const Status status = folders.prepare(options.output); !status) {
        logError(status.error());
        return kExitInternal;
    }
    const Result<particles::ParticleSet> set =
        particles::load(options.input, options.radius, "give it in metres: sluice convert --radius METRES IN OUT");
    if (!set) {
        logError(set.error());
        return kExitBadInput;
    }
    if (const Status saved = particles::save(options.output, set.value()); !saved) {
        logError(saved.error());
        return saved.error().code == SLUICE_ERROR_INVALID_ARGUMENT ? kExitUsage : kExitInternal;
    }
    fmt::print("{}: {} particles of radius {:.5f} m\n", options.output, formatCount(set.value().count()),
               set.value().radius);
    return kExitOk;
}

}  // namespace sluice::cli
