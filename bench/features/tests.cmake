# What a scene pays for a feature that it does not use: nothing. Counted in instructions, where valgrind is there;
# it runs no program that a sanitizer has part in.
if(TARGET plumb_features AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_test(NAME bench/features
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/bench/features/features.py --check $<TARGET_FILE:plumb_features>)
  set_tests_properties(bench/features PROPERTIES LABELS slow SKIP_RETURN_CODE 77 TIMEOUT 900)
endif()
