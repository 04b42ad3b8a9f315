# SPDX-License-Identifier: Apache-2.0
# Installs the tree built in ${build} beside it, then builds and runs with it, as projects of their
# own: tests/consume, apps/embed_example, and the latter by pkg-config too; and makes the Debian
# package and runs the simulator from it.
set(prefix ${build}/consume/prefix)
cmake_path(SET root NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../..)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# build_project(<source> <folder>)
function(build_project source folder)
  run(${CMAKE_COMMAND} -S ${source} -B ${folder} -G ${generator}
      -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${compiler}
      -D CMAKE_BUILD_TYPE=${build_type})
  run(${CMAKE_COMMAND} --build ${folder})
endfunction()

# run_example(<program>): its hand ends near its place, and its feet carry it.
function(run_example program)
  execute_process(COMMAND ${program} ${prefix}/share/softgauss/robots/humanoid.urdf
    OUTPUT_VARIABLE text COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
  message("${text}")
  if(NOT text MATCHES "2.0 s: hand off by +([0-9]+) mm, feet carry +([0-9]+) . +([0-9]+) N")
    message(FATAL_ERROR "${program} does not say where its hand is at the end")
  endif()
  set(off ${CMAKE_MATCH_1})
  math(EXPR carried "${CMAKE_MATCH_2} + ${CMAKE_MATCH_3}")
  # Of a way of 250 mm, and of the weight of a humanoid of some 40 kg.
  if(off GREATER 50 OR carried LESS 200 OR carried GREATER 800)
    message(FATAL_ERROR "${program}: the hand is off by ${off} mm, the feet carry ${carried} N")
  endif()
endfunction()

file(REMOVE_RECURSE ${build}/consume)
run(${CMAKE_COMMAND} --install ${build} --prefix ${prefix})
foreach(page IN ITEMS README.md reference/scenes.md reference/goals.md pictures/humanoid.png)
  if(NOT EXISTS ${prefix}/share/softgauss/docs/${page})
    message(FATAL_ERROR "docs/${page}, which --help names, is not installed")
  endif()
endforeach()

build_project(${CMAKE_CURRENT_LIST_DIR} ${build}/consume/build)
run(${build}/consume/build/consume ${prefix}/share/softgauss/robots/arm.urdf)

build_project(${root}/apps/embed_example ${build}/consume/embed_example)
run_example(${build}/consume/embed_example/embed_example)

find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  file(GLOB_RECURSE pc ${prefix}/softgauss.pc)
  cmake_path(GET pc PARENT_PATH folder)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${folder}
    ${PKG_CONFIG} --cflags --libs softgauss
    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(${compiler} -O1 ${root}/apps/embed_example/main.cpp -o ${build}/consume/by_pkg_config ${flags})
  run_example(${build}/consume/by_pkg_config)
endif()

find_program(DPKG_DEB dpkg-deb)
cmake_path(GET CMAKE_COMMAND PARENT_PATH folder)
find_program(CPACK cpack HINTS ${folder})
if(DPKG_DEB AND CPACK AND EXISTS ${build}/bin/simulate_gdd)
  run(${CPACK} -G DEB --config ${build}/CPackConfig.cmake -B ${build}/consume/package)
  file(GLOB package ${build}/consume/package/softgauss*.deb)
  run(${DPKG_DEB} -x ${package} ${build}/consume/root)
  file(GLOB_RECURSE python ${build}/consume/root/*.py ${build}/consume/root/*.pyi)
  if(python)
    message(FATAL_ERROR "the package has files of the Python module, which it is made without: ${python}")
  endif()
  run(${build}/consume/root/usr/bin/simulate_gdd
      ${build}/consume/root/usr/share/softgauss/robots/arm.urdf --duration 0.1 --passive)
endif()
