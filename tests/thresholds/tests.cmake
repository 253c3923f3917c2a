# Critical values: the search, the scenes, plumb-precise's own values, and the program.
plumb_add_tests(thresholds unit LINK plumb_catalogue nlohmann_json::nlohmann_json)
target_sources(test_thresholds PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/app/program.cpp)
target_compile_definitions(test_thresholds PRIVATE PLUMB_PROGRAM="$<TARGET_FILE:plumb_app>"
  PLUMB_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_dependencies(test_thresholds plumb_app)
