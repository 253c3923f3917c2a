# One test a scenario and engine, found by asking the program.
plumb_add_tests(agreement agreement LINK plumb_catalogue nlohmann_json::nlohmann_json)

# Engines that run as programs of their own are looked for beside the tests' folder, in bin.
foreach(worker IN ITEMS plumb_worker_bullet_double plumb_worker_bullet_multibody)
  if(TARGET test_agreement AND TARGET ${worker})
    add_dependencies(test_agreement ${worker})
  endif()
endforeach()
