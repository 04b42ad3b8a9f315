# SPDX-License-Identifier: Apache-2.0
# Finds a Python with headers and numpy, and pybind11: sets softgauss_with_python.

# Of several Pythons, one that has numpy: where a distribution's packages are, say.
if(NOT DEFINED Python_EXECUTABLE AND NOT DEFINED Python_ROOT_DIR)
  foreach(candidate IN ITEMS python3 /usr/bin/python3)
    find_program(found ${candidate} NO_CACHE)
    if(found)
      execute_process(COMMAND ${found} -c "import numpy, sys; print(sys.executable)"
        OUTPUT_VARIABLE executable OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
      if(executable)
        set(Python_EXECUTABLE ${executable})
        break()
      endif()
      unset(found)
    endif()
  endforeach()
endif()

find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 QUIET CONFIG)
if(NOT Python_FOUND OR NOT pybind11_FOUND)
  message(STATUS "softgauss: the Python module is left out, Python's headers or pybind11 were not found")
  return()
endif()

set(softgauss_with_python ON)
