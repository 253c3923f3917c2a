# The course: its checks, a learner's engine that makes mistakes when asked to, and the starters.
plumb_add_tests(course process LINK plumb_catalogue nlohmann_json::nlohmann_json)
set(folder ${CMAKE_CURRENT_SOURCE_DIR}/course/student)
set(engine ${PROJECT_SOURCE_DIR}/harness/course/student)
set(student ${engine}/student.cpp ${engine}/world.cpp ${engine}/forces.cpp ${engine}/touches.cpp ${engine}/answers.cpp
  ${engine}/joints.cpp ${engine}/edit.cpp ${engine}/rows.cpp ${engine}/clipping.cpp
  ${engine}/misplaced.cpp ${engine}/pairs.cpp)
target_sources(test_course PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/app/program.cpp)

add_executable(plumb_course_student ${folder}/main.cpp ${student})
target_link_libraries(plumb_course_student PRIVATE plumb_reference_support plumb_options)

set(starters ${PROJECT_SOURCE_DIR}/docs/course/starters)
add_executable(plumb_course_starter ${starters}/ball.cpp)
target_link_libraries(plumb_course_starter PRIVATE nlohmann_json::nlohmann_json)

# Starts programs in Python by forking one that runs already.
add_executable(plumb_warm_start ${CMAKE_CURRENT_SOURCE_DIR}/course/warm/main.cpp)

find_program(PLUMB_NODE NAMES node nodejs)
add_dependencies(test_course plumb_app plumb_course_student plumb_course_starter plumb_warm_start)
target_compile_definitions(test_course PRIVATE PLUMB_PROGRAM="$<TARGET_FILE:plumb_app>"
  PLUMB_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
  PLUMB_STUDENT="$<TARGET_FILE:plumb_course_student>" PLUMB_STARTER_CPP="$<TARGET_FILE:plumb_course_starter>"
  PLUMB_STARTERS="${starters}" PLUMB_CIRCLES="${CMAKE_CURRENT_SOURCE_DIR}/course/circles.py"
  $<$<BOOL:${PLUMB_NODE}>:PLUMB_NODE="${PLUMB_NODE}">)

set(check ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/course/check_pages.py)
add_test(NAME course/pages COMMAND ${check} ${PROJECT_SOURCE_DIR})
add_test(NAME course/pages_self_test COMMAND ${check} --self-test)
add_test(NAME course/output COMMAND ${check} --output ${PROJECT_SOURCE_DIR}
  $<TARGET_FILE:plumb_app> $<TARGET_FILE:plumb_course_student>)
add_test(NAME course/figures COMMAND ${check} --figures ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR})
set_tests_properties(course/pages course/pages_self_test course/output course/figures PROPERTIES LABELS unit TIMEOUT 120)

add_test(NAME course/skeletons COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/course/skeletons.py ${starters})
set_tests_properties(course/skeletons PROPERTIES LABELS unit TIMEOUT 60)
# All of each take minutes: the first sixth is run every time.
foreach(part 1 2 3 4 5 6)
  add_test(NAME course/planted_mistakes/${part} COMMAND ${Python3_EXECUTABLE}
    ${CMAKE_CURRENT_SOURCE_DIR}/course/planted_mistakes.py $<TARGET_FILE:plumb_app> $<TARGET_FILE:plumb_warm_start>
      ${starters} --part ${part}/6)
  add_test(NAME course/whole_engine_mistakes/${part} COMMAND ${Python3_EXECUTABLE}
    ${CMAKE_CURRENT_SOURCE_DIR}/course/whole_engine_mistakes.py $<TARGET_FILE:plumb_app>
      $<TARGET_FILE:plumb_warm_start> --part ${part}/6)
  add_test(NAME course/common_mistakes/${part} COMMAND ${Python3_EXECUTABLE}
    ${CMAKE_CURRENT_SOURCE_DIR}/course/common_mistakes.py $<TARGET_FILE:plumb_app> $<TARGET_FILE:plumb_warm_start>
      ${starters} --part ${part}/6)
  set_tests_properties(course/planted_mistakes/${part} course/whole_engine_mistakes/${part}
    course/common_mistakes/${part} PROPERTIES LABELS "process;long" TIMEOUT 600)
endforeach()
set_tests_properties(course/planted_mistakes/1 course/whole_engine_mistakes/1 course/common_mistakes/1 PROPERTIES
  LABELS process)
