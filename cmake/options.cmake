# Compile options of every target, in one place.

# Where nothing but the library is built, and in builds from nothing, several files are compiled as one source, in half
# of the time. Elsewhere a change compiles its own file alone.
option(PLUMB_UNITY "Compile several files of a folder as one source" ${PLUMB_LIBRARY_ONLY})
option(PLUMB_PRECOMPILED "Precompile the headers of libraries for the tests and the program" OFF)
include(${CMAKE_CURRENT_LIST_DIR}/together.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/supported_options.cmake)

add_library(plumb_options INTERFACE)
target_compile_features(plumb_options INTERFACE cxx_std_20)

# The same bits everywhere: no fused multiply-add. g++ 12 contracts across statements even with
# -ffp-contract=off when the target has FMA, so the instructions are taken away as well.
set(plumb_exact_wanted -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
  list(APPEND plumb_exact_wanted -mno-fma)
endif()
plumb_supported_options(plumb_exact ${plumb_exact_wanted})
if(NOT plumb_exact STREQUAL plumb_exact_wanted)
  message(WARNING "The compiler does not take all of ${plumb_exact_wanted}: the bits may differ from those of other builds")
endif()
target_compile_options(plumb_options INTERFACE ${plumb_exact})
target_compile_definitions(plumb_options INTERFACE $<$<BOOL:${PLUMB_SCALAR}>:PLUMB_SCALAR>)

if(PLUMB_UNITY)
  # g++ looks for memory to use again from 128 MiB on, for 3 to 10 % of its time; few sources need 512.
  # It also takes sources that another includes for headers, whose hidden types would differ from source to source.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    plumb_supported_options(plumb_quick --param=ggc-min-heapsize=524288 -Wno-subobject-linkage)
    target_compile_options(plumb_options INTERFACE ${plumb_quick})
  endif()
endif()

# The rest is for work on plumb itself; a project that takes plumb in keeps its own ways.
if(PROJECT_IS_TOP_LEVEL)
  string(FIND "${CMAKE_CXX_FLAGS}" "-fsanitize" at)
  if(at GREATER -1)
    set(plumb_sanitized ON)
  endif()
  plumb_supported_options(plumb_warnings -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
  target_compile_options(plumb_options INTERFACE
    ${plumb_warnings}
    # g++ 12 sees overlaps in std::string + literal that are not there (GCC bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    # With a sanitizer's calls in between it takes variants for uninitialised (its manual, at -fsanitize).
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${plumb_sanitized}>>:-Wno-maybe-uninitialized>
    $<$<BOOL:${PLUMB_WERROR}>:-Werror>)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

  # Paths in the cache are relative to the checkout, so that a copy of it shares what was compiled.
  # Looked for once: a tree that was built without it would otherwise be compiled again when it comes.
  if(NOT DEFINED CACHE{CCACHE_PROGRAM})
    find_program(CCACHE_PROGRAM ccache)
    if(NOT CCACHE_PROGRAM)
      set(CCACHE_PROGRAM "" CACHE FILEPATH "caches what was compiled; empty: none" FORCE)
    endif()
  endif()
  mark_as_advanced(CCACHE_PROGRAM)
  if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # Keeps what was compiled with precompiled headers only where their macros may differ from what they were made with.
    # Compares the text of headers (CCACHE_DEPEND), not what is left of it after preprocessing: where comments alone
    # differ, the precompiled header of another checkout would be taken, which g++ then takes for another file and
    # reads the header twice.
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_DEPEND=1
      CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  endif()
endif()
