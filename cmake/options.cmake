# Compile options of every target, in one place.
add_library(plumb_options INTERFACE)
target_compile_features(plumb_options INTERFACE cxx_std_20)

# The same bits everywhere: no fused multiply-add. g++ 12 contracts across statements even with
# -ffp-contract=off when the target has FMA, so the instructions are taken away as well.
target_compile_options(plumb_options INTERFACE -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
  target_compile_options(plumb_options INTERFACE -mno-fma)
endif()
target_compile_definitions(plumb_options INTERFACE $<$<BOOL:${PLUMB_SCALAR}>:PLUMB_SCALAR>)

# The rest is for work on plumb itself; a project that takes plumb in keeps its own ways.
if(PROJECT_IS_TOP_LEVEL)
  string(FIND "${CMAKE_CXX_FLAGS}" "-fsanitize" at)
  if(at GREATER -1)
    set(plumb_sanitized ON)
  endif()
  target_compile_options(plumb_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
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
    set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} ${CCACHE_PROGRAM})
  endif()
endif()
