# The float build of Bullet, through CMake's own module: the CONFIG files that Debian ships name folders that
# are not there.
find_package(Bullet MODULE QUIET)
if(BULLET_FOUND AND NOT TARGET plumb_bullet_float)
  add_library(plumb_bullet_float STATIC ${CMAKE_CURRENT_SOURCE_DIR}/bullet/backend.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/bullet/simulator.cpp)
  target_include_directories(plumb_bullet_float SYSTEM PRIVATE ${BULLET_INCLUDE_DIRS})
  target_link_libraries(plumb_bullet_float PUBLIC plumb_reference_support PRIVATE ${BULLET_LIBRARIES})
endif()
