if(TARGET test_harness)
  target_compile_definitions(test_harness PRIVATE PLUMB_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
endif()
