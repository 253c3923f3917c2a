# The window's tests; without its libraries there is no window, and none of them.
if(TARGET plumb_window)
  plumb_add_tests(window unit LINK plumb_window plumb_demos plumb_catalogue PNG::PNG)
  target_sources(test_window PRIVATE app/program.cpp)
  target_include_directories(test_window SYSTEM PRIVATE ${PLUMB_IMGUI_INCLUDE})
  target_link_libraries(test_window PRIVATE ${PLUMB_IMGUI_LIBRARY} ${PLUMB_STB_LIBRARY} SDL2::SDL2)
  target_compile_definitions(test_window PRIVATE PLUMB_PROGRAM="$<TARGET_FILE:plumb_app>"
    PLUMB_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  add_dependencies(test_window plumb_app plumb_window_app)
else()
  message(STATUS "The window's tests are left out with the window")
endif()
