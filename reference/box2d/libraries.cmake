# Box2D 2 and Box2D 3 may both be there, and both packages define the target box2d::box2d: what was found of the third is
# kept in a directory of its own, as plumb_box2d_v3.
include_guard(DIRECTORY)
add_subdirectory(${CMAKE_CURRENT_LIST_DIR}/v3)
find_package(box2d 2.4 CONFIG QUIET)
