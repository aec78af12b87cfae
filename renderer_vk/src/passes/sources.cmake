# SPDX-License-Identifier: MIT
# Included by renderer_vk/CMakeLists.txt: the pass plan and the passes.
list(APPEND SLUICE_VK_SOURCES
    src/plan/check_ranges.cpp
    src/plan/plan.cpp
    src/plan/explain.cpp
    src/passes/arena.cpp
    src/passes/capture_depth.cpp
    src/passes/context.cpp
    src/passes/echo.cpp
    src/passes/filter.cpp
    src/passes/fluid_recorder.cpp
    src/passes/foam.cpp
    src/passes/frame_constants.cpp
    src/passes/pipeline.cpp
    src/passes/shade.cpp
    src/passes/splat.cpp
    src/passes/surface.cpp
    src/passes/tiles.cpp
)
list(APPEND SLUICE_VK_LIBS sluice_shaders)
