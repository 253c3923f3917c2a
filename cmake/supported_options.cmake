# Options that the compiler at hand takes.
include(CheckCXXCompilerFlag)

# plumb_supported_options(RESULT OPTION...) sets RESULT to those options that the C++ compiler takes without a word. Asks
# for all at once first: usually it takes them, and one question is enough.
function(plumb_supported_options result)
  set(taken ${ARGN})
  string(MAKE_C_IDENTIFIER "PLUMB_TAKES_${ARGN}" all)
  string(REPLACE ";" " " together "${ARGN}")
  check_cxx_compiler_flag("${together}" ${all})
  if(NOT ${all})
    set(taken "")
    foreach(option IN LISTS ARGN)
      string(MAKE_C_IDENTIFIER "PLUMB_TAKES_${option}" one)
      check_cxx_compiler_flag(${option} ${one})
      if(${one})
        list(APPEND taken ${option})
      endif()
    endforeach()
  endif()
  set(${result} ${taken} PARENT_SCOPE)
endfunction()
