# Compile options of every target, in one place.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
endif()

add_library(plumb_options INTERFACE)
target_compile_features(plumb_options INTERFACE cxx_std_20)
target_compile_options(plumb_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<BOOL:${PLUMB_WERROR}>:-Werror>
  # The same bits everywhere: no fused multiply-add. g++ 12 contracts across statements even with
  # -ffp-contract=off when the target has FMA, so the instructions are taken away as well.
  -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
  target_compile_options(plumb_options INTERFACE -mno-fma)
endif()
target_compile_definitions(plumb_options INTERFACE $<$<BOOL:${PLUMB_SCALAR}>:PLUMB_SCALAR>)
