# SPDX-License-Identifier: MIT
# Included by renderer_vk/CMakeLists.txt: the fluid solver.
list(APPEND SLUICE_VK_SOURCES
    src/simulation/bodies.cpp
    src/simulation/body_contacts.cpp
    src/simulation/buffers.cpp
    src/simulation/kernels.cpp
    src/simulation/check_sources.cpp
    src/simulation/density_kernel.cpp
    src/simulation/depth.cpp
    src/simulation/depth_field.cpp
    src/simulation/distance_grid.cpp
    src/simulation/fluids.cpp
    src/simulation/mesh.cpp
    src/simulation/parameters.cpp
    src/simulation/settings.cpp
    src/simulation/single_pass.cpp
    src/simulation/solid.cpp
    src/simulation/solver.cpp
    src/simulation/solver_room.cpp
    src/simulation/solver_shape.cpp
    src/simulation/solver_step.cpp
    src/simulation/solver_whitewater.cpp
    src/simulation/sources.cpp
    src/simulation/step_timer.cpp
    src/simulation/time_step.cpp
    src/simulation/transfer.cpp
)
