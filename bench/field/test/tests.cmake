# The ruler against closed forms, the scenes' counts, and every scene on every engine for a few steps.
if(TARGET plumb_field_objects)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
  add_executable(test_bench_field ${sources})
  target_link_libraries(test_bench_field PRIVATE plumb_field_objects plumb_options GTest::gmock GTest::gtest_main)
  target_compile_definitions(test_bench_field PRIVATE PLUMB_FIELD_PROGRAM="$<TARGET_FILE:plumb_field>")
  add_dependencies(test_bench_field plumb_field)
  gtest_discover_tests(test_bench_field NO_PRETTY_VALUES TEST_PREFIX bench/field/
    PROPERTIES LABELS unit TIMEOUT 300 DISCOVERY_TIMEOUT 60)
endif()
