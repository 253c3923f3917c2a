# `cmake --install`: by component, `--component runtime` (libplumb.so), `c` (what C programs are built with) `cpp`
# (the library and headers for C++) and `harness` (the program plumb, and what scenarios outside the sources are built
# with: app/CMakeLists.txt). Packages for find_package(plumb) and for pkg-config (plumb-c, plumb) go along.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Headers name each other as programs do, so only the folder above theirs is on a program's search path.
install(CODE "
  set(CHECKOUT \"${PROJECT_SOURCE_DIR}\")
  include(\"${PROJECT_SOURCE_DIR}/cmake/public_headers.cmake\")
  foreach(kind public former)
    cmake_language(CALL plumb_write_\${kind}_headers \"\${CHECKOUT}\"
      \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}\")
  endforeach()"
  COMPONENT cpp)
install(TARGETS plumb_engine EXPORT plumbTargets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT cpp
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT cpp)

install(TARGETS plumb_c plumb_c_static EXPORT plumbCTargets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT c
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT c)
install(FILES ${PROJECT_SOURCE_DIR}/bindings/c/include/plumb/plumb.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/plumb COMPONENT c)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/plumb)
install(EXPORT plumbTargets NAMESPACE plumb:: DESTINATION ${package_dir} COMPONENT cpp)
install(EXPORT plumbCTargets NAMESPACE plumb:: DESTINATION ${package_dir} COMPONENT c)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/plumbConfig.cmake.in
  ${PROJECT_BINARY_DIR}/plumbConfig.cmake INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
# Below 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/plumbConfigVersion.cmake COMPATIBILITY SameMinorVersion)

# Paths in the .pc files are relative to the files themselves: the installed tree can be moved as a whole.
file(RELATIVE_PATH PLUMB_PC_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
foreach(component c cpp)
  install(FILES ${PROJECT_BINARY_DIR}/plumbConfig.cmake ${PROJECT_BINARY_DIR}/plumbConfigVersion.cmake
    DESTINATION ${package_dir} COMPONENT ${component})
endforeach()
foreach(package plumb-c:c plumb:cpp)
  string(REPLACE ":" ";" package ${package})
  list(POP_FRONT package name component)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
    COMPONENT ${component})
endforeach()

# `cpack -G TGZ` in the build folder: a tarball a component. `cpack --config CPackSourceConfig.cmake`: the sources.
set(CPACK_PACKAGE_NAME plumb)
set(CPACK_PACKAGE_VENDOR plumb)
set(CPACK_PACKAGE_FILE_NAME plumb-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
set(CPACK_COMPONENTS_ALL runtime c cpp)
if(NOT PLUMB_LIBRARY_ONLY)
  list(APPEND CPACK_COMPONENTS_ALL harness)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_GENERATOR TGZ)
set(CPACK_SOURCE_GENERATOR TGZ)
set(CPACK_SOURCE_PACKAGE_FILE_NAME plumb-${PROJECT_VERSION})
set(CPACK_SOURCE_IGNORE_FILES "/build/;/[.]git/;/[.]git$;/results/;/hunt/")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
if(PROJECT_IS_TOP_LEVEL)
  include(CPack)
endif()
