// SPDX-License-Identifier: MIT
// A message of every kind, no field at its default.
#pragma once

#include <string_view>
#include <vector>

#include "sluice/abi_sizes.hpp"
#include "sluice/isolate/messages.hpp"

namespace sluice::isolate::test {

inline std::uint32_t descriptorsOf(const Message& message) {
    return std::visit([](const auto& held) { return held.kFdsMin; }, message);
}

inline std::vector<Message> sampleMessages() {
    auto info = sized<SluiceCreateInfo>();
    info.width = 320;
    info.height = 180;
    info.image_sets = 2;
    info.host = sized<SluiceHostCapabilities>();
    auto frame = sized<SluiceFrame>();
    frame.frame = 3;
    frame.wait_value = 5;
    auto image = sized<SluiceImageExport>();
    image.role = SLUICE_IMAGE_FLUID_DEPTH;
    image.allocation_size = 4096;
    auto needs = sized<SluiceSceneNeeds>();
    needs.particle_count = 7;
    auto stats = sized<SluiceFrameStats>();
    stats.pass_count = 2;
    auto bodies = sized<SluiceBodies>();
    bodies.count = 3;
    TracePoint point;
    point.begin_ns = 12;
    std::string_view("splat_depth").copy(point.name.data(), 31);
    return {Hello{{}, SLUICE_ABI_VERSION, 9, 1, 4},
            Describe{{}, 1, info},
            Explain{{}, needs},
            Create{{}, 1, info},
            Info{},
            Resize{{}, 17, 19},
            SetParticles{{}, 100, 0.02F, 1, 1},
            SetEnvironment{{}, 64, 32},
            SubmitFrame{{}, frame},
            Poll{{}, 3},
            TimelineValue{{}, 1},
            TimelineExport{{}, 1, 9},
            ProbeFormat{{}, 1, SLUICE_FORMAT_R32F, 67, 43, info},
            Destroy{},
            Welcome{{}, SLUICE_ABI_VERSION, "renderer", "1.0"},
            Returned{{}, SLUICE_ERROR_DEVICE_LOST, 8, "lost", std::monostate{}},
            Returned{{}, SLUICE_OK, 0, "", sized<SluiceRendererCapabilities>()},
            Returned{{}, SLUICE_OK, 0, "", sized<SluiceRendererInfo>()},
            Returned{{}, SLUICE_OK, 0, "", stats},
            Log{{}, SLUICE_LOG_WARNING, "a line"},
            TraceEvents{{}, {point, point}},
            Line{{}, "splat_depth: particles"},
            ShareImage{{}, image},
            RetireImage{{}, 2, 1},
            Canary{{}, 8, image},
            Answer{{}, SLUICE_ERROR_IMPORT, "no memory"},
            SetSimulation{{}, 1, sized<SluiceSimulation>()},
            Simulate{{}, 5, 0.125},
            SimulationStats{},
            Returned{{}, SLUICE_OK, 0, "", sized<SluiceSimulationStats>()},
            SimulationBodies{{}, 6},
            SetBody{{}, 2, sized<SluiceBodyTarget>()},
            SetFlow{{}, sized<SluiceFlow>()},
            ResetSimulation{{}, 1, 1, sized<SluiceStart>()},
            Returned{{}, SLUICE_OK, 0, "", bodies}};
}

}  // namespace sluice::isolate::test
