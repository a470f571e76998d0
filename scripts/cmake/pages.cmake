# SPDX-License-Identifier: Apache-2.0
# The verbs that are Python programs: `handcast VERB` starts bin/handcast-VERB, whose modules are in share/handcast/pages.
cmake_path(SET share NORMALIZE ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/../share/handcast)
file(MAKE_DIRECTORY ${share})
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/scripts/pages ${share}/pages SYMBOLIC)
install(DIRECTORY scripts/pages DESTINATION ${HANDCAST_INSTALL_SHAREDIR} COMPONENT tools
  PATTERN program.in EXCLUDE PATTERN __pycache__ EXCLUDE)

foreach(verb benchmark calibration-page chart report)
  set(program ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/handcast-${verb})
  configure_file(scripts/pages/program.in ${program} @ONLY FILE_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  handcast_install_program(PROGRAMS ${program} scripts/pages/${verb})
endforeach()
