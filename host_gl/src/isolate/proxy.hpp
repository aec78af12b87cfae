// SPDX-License-Identifier: MIT
// The functions of sluice/plugin.h for a renderer in another process.
#pragma once

#include <cstdint>

#include "sluice/plugin.h"

namespace sluice::host {
class Isolation;
}

namespace sluice::host::proxy {

SluiceResult describe(Isolation& plugin, const SluiceHostServices* host, const SluiceCreateInfo* info,
                      SluiceRendererCapabilities* capabilities, SluiceError* error);
SluiceResult explain(Isolation& plugin, const SluiceSceneNeeds* needs, SluiceLineSink sink, void* user,
                     SluiceError* error);
SluiceResult create(Isolation& plugin, const SluiceHostServices* host, const SluiceCreateInfo* info,
                    SluiceRenderer** renderer, SluiceError* error);
SluiceResult probeFormat(Isolation& plugin, const SluiceHostServices* host, const SluiceCreateInfo* info,
                         std::uint32_t format, std::uint32_t width, std::uint32_t height, SluiceError* error);
/// The table of what is called with a renderer; the four above are missing in it.
[[nodiscard]] SluiceRendererApi rendererFunctions();

}  // namespace sluice::host::proxy
