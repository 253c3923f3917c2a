# plumb_add_scenarios(TARGET FILE... [ENGINES NAME...] [LABEL LABEL])
#
# Builds scenarios (docs/adding-a-scenario.md) that lie outside plumb's sources as a module, which the installed program
# `plumb` loads (PLUMB_SCENARIOS), and adds a ctest entry for each case: TARGET/CASE. A test runs the case on the engines
# NAME (plumb, plumb-float and plumb-precise unless given) and fails where one misses what the scenario expects of it.
set(PLUMB_SCENARIOS_FOLDER ${CMAKE_CURRENT_LIST_DIR})

function(plumb_add_scenarios target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "LABEL" "ENGINES")
  if(NOT arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "plumb_add_scenarios(${target} ...) names no file")
  endif()
  if(NOT arg_ENGINES)
    set(arg_ENGINES plumb plumb-float plumb-precise)
  endif()
  if(NOT arg_LABEL)
    set(arg_LABEL ${target})
  endif()
  set(version ${CMAKE_CURRENT_BINARY_DIR}/${target}_version.cpp)
  file(CONFIGURE OUTPUT ${version} @ONLY CONTENT
    "extern \"C\" const char* plumb_scenarios_version() { return \"@plumb_VERSION@\"; }\n")
  add_library(${target} MODULE ${arg_UNPARSED_ARGUMENTS} ${version})
  target_compile_features(${target} PRIVATE cxx_std_20)
  # The truth's digits are those of the program: no fused multiply-add.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  target_include_directories(${target} SYSTEM PRIVATE ${PLUMB_SCENARIOS_INCLUDE}/plumb/compat ${PLUMB_SCENARIOS_INCLUDE})
  target_link_libraries(${target} PRIVATE plumb::program)

  # The names of the cases are known once the module is built.
  set(tests ${CMAKE_CURRENT_BINARY_DIR}/${target}_tests.cmake)
  list(JOIN arg_ENGINES "," engines)
  add_custom_command(TARGET ${target} POST_BUILD VERBATIM BYPRODUCTS ${tests}
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:plumb::program> -DMODULE=$<TARGET_FILE:${target}> -DTARGET=${target}
      -DENGINES=${engines} -DLABEL=${arg_LABEL} -DTESTS=${tests} -P ${PLUMB_SCENARIOS_FOLDER}/plumbListScenarios.cmake)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake @ONLY CONTENT
    "if(EXISTS \"@tests@\")\n  include(\"@tests@\")\nelse()\n  add_test(@target@_not_built @target@_not_built)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
endfunction()
