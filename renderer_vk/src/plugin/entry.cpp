// SPDX-License-Identifier: MIT
// The one symbol that the plugin exports.
#include "plugin/api.hpp"

extern "C" __attribute__((visibility("default"))) const SluiceRendererApi* sluice_renderer_entry(
    std::uint32_t abi_version) {
    return sluice::vk::rendererApi(abi_version);
}
