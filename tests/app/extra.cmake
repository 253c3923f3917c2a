# The tests of the command line drive the program itself.
if(TARGET test_app)
  target_compile_definitions(test_app PRIVATE PLUMB_PROGRAM="$<TARGET_FILE:plumb_app>"
    PLUMB_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  add_dependencies(test_app plumb_app)
  if(TARGET plumb_bench)
    add_dependencies(test_app plumb_bench)
  endif()
  foreach(worker IN ITEMS plumb_worker_bullet_double plumb_worker_bullet_multibody)
    if(TARGET ${worker})
      add_dependencies(test_app ${worker})
    endif()
  endforeach()
endif()
