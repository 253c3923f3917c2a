# One test a scenario and engine, found by asking the program; those of large scenes are labelled slow.
file(GLOB agreement_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/agreement/*.cpp)
add_executable(test_agreement ${agreement_sources})
target_link_libraries(test_agreement PRIVATE plumb_options GTest::gmock GTest::gtest_main plumb_catalogue)
gtest_discover_tests(test_agreement TEST_PREFIX agreement/ TEST_FILTER -Slow/* TEST_LIST agreement_quick
  PROPERTIES LABELS agreement TIMEOUT 600 DISCOVERY_TIMEOUT 60)
gtest_discover_tests(test_agreement TEST_PREFIX agreement/ TEST_FILTER Slow/* TEST_LIST agreement_slow
  PROPERTIES LABELS "agreement\\;slow" TIMEOUT 1200 DISCOVERY_TIMEOUT 60)
# Engines that run as programs of their own are looked for beside the tests' folder, in bin.
if(TARGET plumb_worker_bullet_double)
  add_dependencies(test_agreement plumb_worker_bullet_double)
endif()
