# The npm package is compiled by another compiler, along with the page for browsers: `./plumb web`.
if(PLUMB_WEB)
  include(ExternalProject)
  ExternalProject_Add(plumb_javascript SOURCE_DIR ${CMAKE_CURRENT_LIST_DIR} BINARY_DIR ${PROJECT_SOURCE_DIR}/build/javascript
    CMAKE_ARGS -DCMAKE_BUILD_TYPE=Release
      -DCMAKE_TOOLCHAIN_FILE=${PROJECT_SOURCE_DIR}/demos/web/wasm32-wasi.cmake
    BUILD_ALWAYS ON USES_TERMINAL_BUILD ON INSTALL_COMMAND "")
  add_dependencies(plumb_web plumb_javascript)
endif()
