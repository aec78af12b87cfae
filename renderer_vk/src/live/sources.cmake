# SPDX-License-Identifier: MIT
# Included by renderer_vk/CMakeLists.txt: the fluid that flows while the host thinks.
list(APPEND SLUICE_VK_SOURCES
    src/live/body_reports.cpp
    src/live/foam_age.cpp
    src/live/live_reset.cpp
    src/live/live_simulation.cpp
    src/live/one_set.cpp
    src/live/output_slots.cpp
    src/live/particle_places.cpp
    src/live/seen_depths.cpp
)
