# SPDX-License-Identifier: MIT
# What `sluice diagnose` prints and draws, as strings; no file is written here. Included by cli/CMakeLists.txt.
set(page ${CMAKE_CURRENT_LIST_DIR}/page)
file(READ ${page}/page.css SLUICE_PAGE_CSS)
file(READ ${page}/model.js SLUICE_PAGE_MODEL)
file(READ ${page}/timeline.js SLUICE_PAGE_TIMELINE)
file(READ ${page}/panels.js SLUICE_PAGE_PANELS)
file(READ ${page}/page.html SLUICE_PAGE_HTML)
string(CONFIGURE "${SLUICE_PAGE_HTML}" SLUICE_PAGE @ONLY)
configure_file(${CMAKE_CURRENT_LIST_DIR}/page_text.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/diagnose/page_text.cpp @ONLY)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${page}/page.html ${page}/page.css ${page}/model.js ${page}/timeline.js ${page}/panels.js)

target_sources(sluice_cli_lib PRIVATE
    diagnose/chrome_trace.cpp
    diagnose/diagnosis.cpp
    diagnose/json.cpp
    diagnose/page.cpp
    diagnose/text.cpp
    ${CMAKE_CURRENT_BINARY_DIR}/diagnose/page_text.cpp
)
target_link_libraries(sluice_cli_lib PUBLIC sluice_ledger_log)
