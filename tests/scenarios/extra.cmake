# The scenario that docs/adding-a-scenario.md shows, built as a reader would build it: its first ```cpp block.
if(TARGET test_scenarios)
  set(page ${PROJECT_SOURCE_DIR}/docs/adding-a-scenario.md)
  set(example ${CMAKE_CURRENT_BINARY_DIR}/scenarios/doc_example.cpp)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page})

  # ';' and '[' mean something to CMake's lists, so the text is only ever cut, never split.
  file(READ ${page} text)
  string(FIND "${text}" "```cpp\n" start)
  if(start LESS 0)
    message(FATAL_ERROR "${page} has no \`\`\`cpp block")
  endif()
  math(EXPR start "${start} + 7")
  string(SUBSTRING "${text}" ${start} -1 text)
  string(FIND "${text}" "```" end)
  string(SUBSTRING "${text}" 0 ${end} text)
  file(CONFIGURE OUTPUT ${example} CONTENT "${text}" @ONLY)

  # The files that `plumb new scenario` writes, one of them named as a keyword of the language.
  set(template ${PROJECT_SOURCE_DIR}/app/new_scenario.cpp.in)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${template})
  file(READ ${template} template_text)
  set(newly_written "")
  foreach(name newly_written register)
    string(REPLACE new_scenario_name ${name} text "${template_text}")
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/scenarios/${name}.cpp CONTENT "${text}" @ONLY)
    list(APPEND newly_written ${CMAKE_CURRENT_BINARY_DIR}/scenarios/${name}.cpp)
  endforeach()

  target_sources(test_scenarios PRIVATE ${example} ${newly_written})
  target_compile_definitions(test_scenarios PRIVATE PLUMB_DOC_EXAMPLE="${example}"
    PLUMB_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
endif()
