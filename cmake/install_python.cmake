# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors

# hgrid_install_python(program...): installs copies of these Python programs whose first line names the interpreter that
# the build was configured with. Call it after catkin_install_python(), whose files they replace, and whose programs in
# the devel space already begin with this interpreter. The files that catkin installs begin with "/usr/bin/env python3".
# That is the wrong Python if conda or pyenv is first in PATH: it does not find the modules of ROS.
function(hgrid_install_python)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  foreach(program ${ARGN})
    get_filename_component(name ${program} NAME)
    set(copy "${CMAKE_CURRENT_BINARY_DIR}/python_programs/${name}")
    file(READ ${program} text)
    string(REGEX REPLACE "^#![^\n]*" "#!${PYTHON_EXECUTABLE}" text "${text}")
    file(WRITE "${copy}" "${text}")
    # Removes the file of catkin first: cmake keeps a file that is as old as the one that would replace it.
    install(CODE "file(REMOVE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION}/${name}\")")
    install(PROGRAMS "${copy}" DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  endforeach()
endfunction()
