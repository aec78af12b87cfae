# SPDX-License-Identifier: MIT
# Included by renderer_vk/CMakeLists.txt: the fluid that flows while the host thinks.
list(APPEND SLUICE_VK_SOURCES
    src/live/live_simulation.cpp
    src/live/output_slots.cpp
)
