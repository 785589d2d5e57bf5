# Where `cmake --install` puts the Python package, below the prefix. Debian's python3 finds it there if the prefix is
# /usr/local; elsewhere PYTHONPATH names the folder. Debian's python3 first: the one in PATH may be another.
find_program(RICOCHET_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(RICOCHET_PYTHON python3)
set(place "python3/dist-packages")
if(RICOCHET_PYTHON)
  execute_process(OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET COMMAND ${RICOCHET_PYTHON} -c
    "import sys; v = sys.version_info; d = any(p.endswith('dist-packages') for p in sys.path)
print(f'python{v.major}.{v.minor}/{\"dist\" if d else \"site\"}-packages')")
  if(found)
    set(place ${found})
  endif()
endif()
set(RICOCHET_PYTHON_DIR "lib/${place}" CACHE STRING "Folder of the Python package, below the prefix")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scripts/ricochet DESTINATION ${RICOCHET_PYTHON_DIR}
  FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
set(python_command "/usr/bin/env python3")
if(RICOCHET_PYTHON)
  set(python_command ${RICOCHET_PYTHON})
endif()
# The command finds the package wherever the prefix is moved to.
file(RELATIVE_PATH python_from_bin /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${RICOCHET_PYTHON_DIR})
configure_file(${PROJECT_SOURCE_DIR}/cmake/ricochet-plot.in ${PROJECT_BINARY_DIR}/ricochet-plot @ONLY)
install(PROGRAMS ${PROJECT_BINARY_DIR}/ricochet-plot DESTINATION ${CMAKE_INSTALL_BINDIR})
