# SPDX-License-Identifier: Apache-2.0
# The handbook (scripts/docs): a page beside each installed document, which share their pictures. It needs two of Debian's Python packages.
execute_process(COMMAND /usr/bin/python3 -c "import jinja2, markdown_it" RESULT_VARIABLE handbook_lacks OUTPUT_QUIET ERROR_QUIET)
if(NOT handbook_lacks EQUAL 0)
  message(STATUS "without the handbook (python3-jinja2 python3-markdown-it)")
  return()
endif()

file(GLOB sources CONFIGURE_DEPENDS *.md docs/*.md docs/*/*.md config/*.md renderer/*.md ipc/*/*.md services/lab/training/*.md
  scripts/handbook/*.py scripts/handbook/templates/* scripts/package.d/help_text.py scripts/pages/templates/page.css)
add_custom_command(OUTPUT ${made}/handbook.stamp
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${made}/handbook
  COMMAND ${CMAKE_SOURCE_DIR}/scripts/handbook/make.py ${made}/handbook --bin ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}
  COMMAND ${CMAKE_COMMAND} -E touch ${made}/handbook.stamp
  DEPENDS ${made_files} ${sources}
  COMMENT "Writing the handbook")
list(APPEND made_files ${made}/handbook.stamp)
install(DIRECTORY ${made}/handbook/ DESTINATION ${CMAKE_INSTALL_DOCDIR}
  FILES_MATCHING PATTERN *.html PATTERN *.css PATTERN *.js)
