# SPDX-License-Identifier: MIT
# Tests of the pass plan and of every pass; included by CMakeLists.txt.
find_package(glm REQUIRED)
find_package(rapidcheck REQUIRED)
add_library(sluice_pass_rig STATIC pass_rig.cpp reference/fluid_reference.cpp)
target_link_libraries(sluice_pass_rig PUBLIC sluice_renderer_vk_core glm::glm PRIVATE sluice_options)
target_include_directories(sluice_pass_rig PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})

sluice_add_test(renderer_vk_plan_test pass_plan_test.cpp LIBS sluice_pass_rig rapidcheck rapidcheck_gtest)
sluice_add_test(renderer_vk_pass_test OPTIMISED
    pass_ellipsoid_test.cpp
    pass_filter_test.cpp
    pass_foam_test.cpp
    pass_looks_test.cpp
    pass_shade_test.cpp
    pass_splat_test.cpp
    pass_surface_test.cpp
    pass_tiles_test.cpp
    LIBS sluice_pass_rig)

# --- the fluid solver ---
sluice_add_test(renderer_vk_simulation_test OPTIMISED
    reference/simulation_reference.cpp
    simulation_bodies_test.cpp
    simulation_depth_test.cpp
    simulation_fluids_test.cpp
    simulation_mesh_test.cpp
    simulation_physics_test.cpp
    simulation_seen_pool_test.cpp
    simulation_seen_test.cpp
    simulation_shape_test.cpp
    simulation_sources_test.cpp
    simulation_step_test.cpp
    simulation_tension_test.cpp
    simulation_whitewater_test.cpp
    LIBS sluice_renderer_vk_core sluice_shaders)
target_include_directories(renderer_vk_simulation_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
