# The double build of Bullet. Most of its symbols share their names with the float build's, so it lives in a
# program of its own; what an adapter links to is the duty to build that program.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(BULLET_DOUBLE QUIET IMPORTED_TARGET bullet-float64)
endif()
if(TARGET PkgConfig::BULLET_DOUBLE AND NOT TARGET plumb_worker_bullet_double)
  add_executable(plumb_worker_bullet_double ${CMAKE_CURRENT_SOURCE_DIR}/workers/bullet_double.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/bullet/backend.cpp ${CMAKE_CURRENT_SOURCE_DIR}/bullet/simulator.cpp)
  set_target_properties(plumb_worker_bullet_double PROPERTIES OUTPUT_NAME plumb-worker-bullet-double
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  target_link_libraries(plumb_worker_bullet_double PRIVATE plumb_reference_support PkgConfig::BULLET_DOUBLE)
  add_library(plumb_with_bullet_double INTERFACE)
  add_dependencies(plumb_with_bullet_double plumb_worker_bullet_double)
endif()
