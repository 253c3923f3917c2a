# Debian's clang with its libc++ and wasi-libc, as a compiler for WebAssembly. Needs the packages clang-16, lld-16,
# wasi-libc, libc++-16-dev-wasm32 and libclang-rt-16-dev-wasm32.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-16)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
# -O0 is the linker driver's: with another it runs wasm-opt, if that is installed, whose older versions refuse SIMD.
# Throwing is compiled to calls, see exceptions.cpp; 128-bit SIMD is in every browser since 2023.
set(CMAKE_CXX_FLAGS_INIT "-fexceptions -msimd128 -isystem /usr/include/wasm32-wasi/c++/v1")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-O0 -mexec-model=reactor -fuse-ld=lld -lc++ -lc++abi -Wl,--gc-sections,--strip-all,-z,stack-size=1048576")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_CXX_COMPILER_WORKS TRUE)
