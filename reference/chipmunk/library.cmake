# Chipmunk as a library and a header: it ships no CMake files.
find_library(PLUMB_CHIPMUNK_LIBRARY chipmunk)
find_path(PLUMB_CHIPMUNK_HEADERS chipmunk/chipmunk.h)
mark_as_advanced(PLUMB_CHIPMUNK_LIBRARY PLUMB_CHIPMUNK_HEADERS)
if(PLUMB_CHIPMUNK_LIBRARY AND PLUMB_CHIPMUNK_HEADERS AND NOT TARGET plumb_chipmunk)
  add_library(plumb_chipmunk INTERFACE)
  target_include_directories(plumb_chipmunk SYSTEM INTERFACE ${PLUMB_CHIPMUNK_HEADERS})
  target_link_libraries(plumb_chipmunk INTERFACE ${PLUMB_CHIPMUNK_LIBRARY})
endif()
