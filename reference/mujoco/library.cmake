# MuJoCo as a library and a header: the CONFIG file that Debian ships names a folder of another package.
find_library(PLUMB_MUJOCO_LIBRARY mujoco)
find_path(PLUMB_MUJOCO_HEADERS mujoco/mujoco.h)
mark_as_advanced(PLUMB_MUJOCO_LIBRARY PLUMB_MUJOCO_HEADERS)
if(PLUMB_MUJOCO_LIBRARY AND PLUMB_MUJOCO_HEADERS AND NOT TARGET plumb_mujoco)
  add_library(plumb_mujoco INTERFACE)
  target_include_directories(plumb_mujoco SYSTEM INTERFACE ${PLUMB_MUJOCO_HEADERS})
  target_link_libraries(plumb_mujoco INTERFACE ${PLUMB_MUJOCO_LIBRARY})
endif()
