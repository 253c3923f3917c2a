# The engines that docs/adding-an-engine.md shows, built and run as a reader would: its first ```cpp block is
# linked into the tests, its first ```python block is started by them. And a program that serves any engine
# that is linked in, over the process protocol.
if(TARGET test_reference)
  set(page ${PROJECT_SOURCE_DIR}/docs/adding-an-engine.md)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page})

  # ';' and '[' mean something to CMake's lists, so the text is only ever cut, never split.
  function(plumb_extract_block language output)
    file(READ ${page} text)
    string(FIND "${text}" "```${language}\n" start)
    if(start LESS 0)
      message(FATAL_ERROR "${page} has no \`\`\`${language} block")
    endif()
    string(LENGTH "```${language}\n" skip)
    math(EXPR start "${start} + ${skip}")
    string(SUBSTRING "${text}" ${start} -1 text)
    string(FIND "${text}" "```" end)
    string(SUBSTRING "${text}" 0 ${end} text)
    file(CONFIGURE OUTPUT ${output} CONTENT "${text}" @ONLY)
  endfunction()

  set(folder ${CMAKE_CURRENT_BINARY_DIR}/reference)
  plumb_extract_block(cpp ${folder}/doc_engine.cpp)
  plumb_extract_block(python ${folder}/doc_engine.py)

  add_executable(plumb_test_worker ${CMAKE_CURRENT_SOURCE_DIR}/reference/worker/serve_any.cpp)
  target_link_libraries(plumb_test_worker PRIVATE plumb_catalogue)

  target_sources(test_reference PRIVATE ${folder}/doc_engine.cpp)
  add_dependencies(test_reference plumb_test_worker)
  target_compile_definitions(test_reference PRIVATE
    PLUMB_DOC_ENGINE="${folder}/doc_engine.py" PLUMB_TEST_WORKER="$<TARGET_FILE:plumb_test_worker>")
endif()
