# SPDX-License-Identifier: Apache-2.0
# Debian's packages, which scripts/package makes by CPack. components.cmake says which program is in which. What is excluded from all is
# in no tree of `cmake --install`.
set(made ${CMAKE_BINARY_DIR}/package)
set(from ${CMAKE_SOURCE_DIR}/scripts/package.d)

# handcast_packaged(component folder file ... [RENAME name]): files that only packages have.
macro(handcast_packaged component folder)
  install(FILES ${ARGN} DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()

# handcast_package(component name section "summary" "description" [NEEDS component ...] [DEPENDS ...] [RECOMMENDS ...] [SUGGESTS ...])
#
# NEEDS: packages of ours, of the same version. DEPENDS: what dpkg-shlibdeps does not find.
macro(handcast_package component name section summary description)
  cmake_parse_arguments(ARG "" "" "NEEDS;DEPENDS;RECOMMENDS;SUGGESTS" ${ARGN})
  string(TOUPPER ${component} upper)
  foreach(relation DEPENDS RECOMMENDS SUGGESTS)
    list(JOIN ARG_${relation} ", " CPACK_DEBIAN_${upper}_PACKAGE_${relation})
  endforeach()
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\nhandcast casts a picture onto moving hands so that it stays there.\n${description}")
  set(CPACK_COMPONENT_${upper}_DEPENDS ${ARG_NEEDS})
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  handcast_packaged(${component} share/doc/${name} ${made}/changelog.gz ${from}/copyright)
  if(EXISTS ${from}/${name}.lintian)
    handcast_packaged(${component} share/lintian/overrides ${from}/${name}.lintian RENAME ${name})
  endif()
endmacro()

if(TARGET handcast-aravis)
  set(industrial handcast-aravis)
endif()
handcast_package(show handcast graphics "light that stays on moving hands"
"It needs an infrared camera, a hand tracker and a projector, or a digital
twin of them. This package runs it, by hand or as the service handcast@RIG."
  DEPENDS "systemd | systemd-standalone-sysusers" "systemd | systemd-standalone-tmpfiles"
  RECOMMENDS handcast-tools ${industrial} fonts-dejavu-core libavdevice59 libegl1 libgl1-mesa-dri
  SUGGESTS handcast-bridge handcast-lab python3-handcast xdg-utils)
handcast_package(tools handcast-tools graphics "light on moving hands: calibration and preview"
"These are the tools of those who set it up: calibration, preview, templates
for pictures, detection in files."
  NEEDS show
  DEPENDS python3:any
  RECOMMENDS python3-jinja2 python3-matplotlib python3-opencv fonts-dejavu-core)
handcast_package(lab handcast-lab science "light on moving hands: simulation and studies"
"This is what measures how good it is: the simulator, sweeps, charts and
reports, a gallery of its looks, studies and games with people."
  NEEDS tools library
  DEPENDS python3:any python3-jinja2 python3-matplotlib python3-opencv)
if(TARGET handcast-aravis)
  handcast_package(aravis handcast-aravis graphics "light on moving hands: industrial cameras"
"With this package its camera is of GigE Vision or USB3 Vision, by Aravis."
    NEEDS show)
endif()
if(HANDCAST_WITH_CYCLONEDDS)
  set(bridge bridge)
  handcast_package(bridge handcast-bridge graphics "light on moving hands: several computers"
"This is the service that joins rigs on several computers, over DDS. Joints are
also sent as messages of ROS 2."
    NEEDS show)
endif()
handcast_package(library libhandcast0 libs "light on moving hands: shared library"
"With this library programs draw on the hands, or are the camera, tracker or
detector.")
handcast_package(dev libhandcast-dev libdevel "light on moving hands: development files"
"These are headers and libraries for programs in C and C++ that read a rig's
streams, draw on the hands, or are the camera, tracker or detector."
  NEEDS library
  DEPENDS libexpected-dev libfmt-dev libglm-dev)
handcast_package(python python3-handcast python "light on moving hands: Python module"
"With this module programs read a rig's streams, draw on the hands, or are the
camera, tracker or detector."
  NEEDS library
  DEPENDS python3:any
  RECOMMENDS python3-numpy)

# Man pages, from what the programs print with --help.
foreach(component show tools lab ${bridge})
  get_property(programs GLOBAL PROPERTY handcast_programs_of_${component})
  set(targets)
  foreach(program ${programs})
    if(TARGET ${program})  # pages need no building
      list(APPEND targets ${program})
    endif()
  endforeach()
  add_custom_command(OUTPUT ${made}/man/${component}.stamp
    COMMAND ${Python3_EXECUTABLE} ${from}/man_pages.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${made}/man/${component} ${programs}
    COMMAND ${CMAKE_COMMAND} -E touch ${made}/man/${component}.stamp
    DEPENDS ${targets} ${from}/man_pages.py ${from}/help_text.py
    COMMENT "Writing the man pages of ${component}")
  list(APPEND made_files ${made}/man/${component}.stamp)
  install(DIRECTORY ${made}/man/${component}/ DESTINATION share/man/man1 COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

add_custom_command(OUTPUT ${made}/handcast.bash
  COMMAND ${Python3_EXECUTABLE} ${from}/completion.py ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${from}/handcast.bash.in ${made}/handcast.bash
  DEPENDS ${made_files} ${from}/completion.py ${from}/handcast.bash.in ${from}/help_text.py
  COMMENT "Writing the completion for bash")
add_custom_command(OUTPUT ${made}/handcast@.service
  COMMAND handcast install-units --print-template /usr/bin/handcast > ${made}/handcast@.service
  DEPENDS handcast
  COMMENT "Writing the unit of the package")
include(handbook)

handcast_packaged(show lib/systemd/system ${made}/handcast@.service)
handcast_packaged(show lib/systemd/system supervisor/succession/units/handcast-reboot@.path)
handcast_packaged(show lib/systemd/system supervisor/succession/units/handcast-reboot@.service)
handcast_packaged(show lib/udev/rules.d config/udev/70-handcast.rules)
handcast_packaged(show lib/sysusers.d ${from}/sysusers.conf RENAME handcast.conf)
handcast_packaged(show lib/tmpfiles.d ${from}/tmpfiles.conf RENAME handcast.conf)
handcast_packaged(show share/bash-completion/completions ${made}/handcast.bash RENAME handcast)
handcast_packaged(show share/metainfo ${from}/org.handcast.Handcast.metainfo.xml)
handcast_packaged(show share/icons/hicolor/scalable/apps ${from}/org.handcast.Handcast.svg)
handcast_packaged(show share/applications ${from}/org.handcast.Handcast.desktop)
handcast_packaged(tools share/applications ${from}/org.handcast.Preview.desktop)
handcast_packaged(python lib/python3/dist-packages scripts/handcast.py)

# All that is packed.
add_custom_target(handcast_packages ALL
  DEPENDS ${made_files} ${made}/handcast@.service ${made}/handcast.bash handcast_c handcast_client handcast-film handcast_hands)
if(industrial)
  add_dependencies(handcast_packages handcast-aravis)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME handcast)
set(CPACK_PACKAGE_CONTACT "see scripts/package.d/pack")  # which also says which version it is
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_SHOW_PACKAGE_CONTROL_EXTRA ${from}/postinst ${from}/prerm ${from}/postrm)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${from}/libhandcast0/shlibs ${from}/libhandcast0/triggers)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
include(CPack)
