# The public headers of plumb and what they include, as others see them: a public header is <plumb/NAME.h>, all else
# that it needs <plumb/detail/PATH>. In the sources they include each other from the checkout's root ("engine/...").
#
#   plumb_public_headers(CHECKOUT FILES)      sets FILES to the paths of all of them, from the checkout's root
#   plumb_write_public_headers(CHECKOUT TO)   writes them to TO/plumb
#   plumb_write_former_headers(CHECKOUT TO)   writes what programs from before version 0.2 include, "engine/...", to
#                                             TO/plumb/compat: those that are public forward to the public ones
#
# As a script: cmake -DCHECKOUT=... -DTO=... -P public_headers.cmake
cmake_policy(VERSION 3.25)
set(PLUMB_PUBLIC_HEADERS
  engine/scene/json.h engine/simulation/simulation.h engine/world/add_scene.h engine/world/debug_draw.h
  engine/world/force_laws.h engine/world/invariant_monitor.h engine/world/mover.h engine/world/queries.h
  engine/world/recorder.h engine/world/replay.h engine/world/rollback.h engine/world/snapshot.h
  engine/world/state_hash.h engine/world/svg_draw.h engine/world/world.h)

function(plumb_public_headers checkout files)
  set(open ${PLUMB_PUBLIC_HEADERS})
  set(all "")
  while(open)
    list(POP_FRONT open path)
    if(NOT path IN_LIST all)
      list(APPEND all ${path})
      file(STRINGS ${checkout}/${path} lines REGEX "^#include \"engine/")
      foreach(line IN LISTS lines)
        string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" included "${line}")
        list(APPEND open ${included})
      endforeach()
    endif()
  endwhile()
  set(${files} ${all} PARENT_SCOPE)
endfunction()

function(plumb_write_public_headers checkout to)
  plumb_public_headers(${checkout} files)
  foreach(path IN LISTS files)
    file(READ ${checkout}/${path} text)
    foreach(public IN LISTS PLUMB_PUBLIC_HEADERS)
      get_filename_component(name ${public} NAME)
      string(REPLACE "#include \"${public}\"" "#include <plumb/${name}>" text "${text}")
    endforeach()
    string(REGEX REPLACE "#include \"engine/([^\"]*)\"" "#include <plumb/detail/\\1>" text "${text}")
    get_filename_component(name ${path} NAME)
    if(NOT path IN_LIST PLUMB_PUBLIC_HEADERS)
      string(REGEX REPLACE "^engine/" "detail/" name ${path})
    endif()
    file(CONFIGURE OUTPUT ${to}/plumb/${name} CONTENT "${text}" @ONLY)
  endforeach()
endfunction()

function(plumb_write_former_headers checkout to)
  plumb_public_headers(${checkout} needed)
  file(GLOB_RECURSE all RELATIVE ${checkout} ${checkout}/engine/*.h)
  foreach(path IN LISTS all)
    if(path IN_LIST PLUMB_PUBLIC_HEADERS)
      get_filename_component(name ${path} NAME)
      set(text "#pragma once\n\n#include <plumb/${name}>\n")
    elseif(path IN_LIST needed)
      string(REGEX REPLACE "^engine/" "detail/" name ${path})
      set(text "#pragma once\n\n#include <plumb/${name}>\n")
    else()
      file(READ ${checkout}/${path} text)
    endif()
    file(CONFIGURE OUTPUT ${to}/plumb/compat/${path} CONTENT "${text}" @ONLY)
  endforeach()
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  plumb_write_public_headers(${CHECKOUT} ${TO})
endif()
