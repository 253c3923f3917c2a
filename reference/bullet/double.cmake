# The double build of Bullet. Most of its symbols share their names with the float build's, so it lives in
# programs of its own; what an adapter links to is the duty to build them.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(BULLET_DOUBLE QUIET IMPORTED_TARGET bullet-float64)
endif()
if(TARGET PkgConfig::BULLET_DOUBLE AND NOT TARGET plumb_with_bullet_double)
  add_library(plumb_with_bullet_double INTERFACE)
  function(plumb_add_bullet_worker name)
    set(target plumb_worker_${name})
    string(REPLACE "_" "-" program plumb-worker-${name})
    add_executable(${target} ${CMAKE_CURRENT_SOURCE_DIR}/workers/${name}.cpp ${ARGN})
    set_target_properties(${target} PROPERTIES OUTPUT_NAME ${program}
      RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
    target_link_libraries(${target} PRIVATE plumb_reference_support PkgConfig::BULLET_DOUBLE)
    add_dependencies(plumb_with_bullet_double ${target})
  endfunction()
  plumb_add_bullet_worker(bullet_double ${CMAKE_CURRENT_SOURCE_DIR}/bullet/backend.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/bullet/simulator.cpp)
  plumb_add_bullet_worker(bullet_multibody ${CMAKE_CURRENT_SOURCE_DIR}/bullet/multibody.cpp)
endif()
