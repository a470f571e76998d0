# SPDX-License-Identifier: Apache-2.0
# Which of Debian's packages a file is in; packages.cmake describes them. Files that do not name a component are in `show`.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME show)

# handcast_component_of(folder result): the component of the programs of a folder.
function(handcast_component_of folder result)
  if(folder MATCHES "^services/tools/(day|devices|doctor|init|lamp|record)$")
    set(component show)  # to set it up; and what the desk starts
  elseif(folder STREQUAL "services/bridge")
    set(component bridge)  # it alone needs CycloneDDS
  elseif(folder MATCHES "^services/tools/|^scripts/pages/calibration")
    set(component tools)
  elseif(folder MATCHES "^services/lab/|^services/studies$|^scripts/pages/")
    set(component lab)
  else()
    set(component show)
  endif()
  set(${result} ${component} PARENT_SCOPE)
endfunction()

# handcast_install_program(TARGETS|PROGRAMS program folder): a target, or a file, in the component of a folder.
function(handcast_install_program kind program folder)
  handcast_component_of(${folder} component)
  install(${kind} ${program} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
  cmake_path(GET program FILENAME name)
  set_property(GLOBAL APPEND PROPERTY handcast_programs_of_${component} ${name})
endfunction()
