# The report: what is written, and the page in a browser.
target_sources(test_report PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/app/program.cpp)
target_compile_definitions(test_report PRIVATE PLUMB_PROGRAM="$<TARGET_FILE:plumb_app>"
  PLUMB_CHART_JS="${PLUMB_CHART_JS}" PLUMB_REPORT_DATA="${CMAKE_CURRENT_SOURCE_DIR}/report/data")
add_dependencies(test_report plumb_app)

find_program(NODE NAMES node nodejs)
find_program(CHROMIUM NAMES chromium chromium-browser google-chrome)
mark_as_advanced(NODE CHROMIUM)
add_test(NAME report/browser COMMAND ${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/report/browser_test.mjs
  $<TARGET_FILE:plumb_app> ${CHROMIUM})
set_tests_properties(report/browser PROPERTIES LABELS web TIMEOUT 300)
if(NOT NODE OR NOT CHROMIUM)
  message(STATUS "Test report/browser is left out: it needs nodejs and chromium")
  set_tests_properties(report/browser PROPERTIES DISABLED TRUE)
endif()
