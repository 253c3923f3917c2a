# The ruler against closed forms, the scenes' counts, and every scene on every engine for a few steps.
if(TARGET plumb_field_objects)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
  add_executable(test_bench_field ${sources})
  target_link_libraries(test_bench_field PRIVATE plumb_field_objects plumb_catalogue plumb_options GTest::gmock GTest::gtest_main)
  target_compile_definitions(test_bench_field PRIVATE PLUMB_FIELD_PROGRAM="$<TARGET_FILE:plumb_field>")
  add_dependencies(test_bench_field plumb_field)
  gtest_discover_tests(test_bench_field NO_PRETTY_VALUES TEST_PREFIX bench/field/
    PROPERTIES LABELS unit TIMEOUT 300 DISCOVERY_TIMEOUT 60)
endif()

# Instructions a step of six scenes: what a change costs shows here where times are noise.
if(TARGET plumb_field AND CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_test(NAME bench/field/instructions
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/bench/field/instructions.py $<TARGET_FILE:plumb_field>)
  set_tests_properties(bench/field/instructions PROPERTIES LABELS slow SKIP_RETURN_CODE 77 TIMEOUT 900)
endif()
