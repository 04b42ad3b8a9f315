# SPDX-License-Identifier: Apache-2.0
# Installs the tree built in ${build} beside it, then builds and runs the consumer with it.
set(prefix ${build}/consume/prefix)
set(consumer ${build}/consume/build)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${build}/consume)
run(${CMAKE_COMMAND} --install ${build} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${consumer} -G ${generator}
    -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_COMPILER=${compiler}
    -D CMAKE_BUILD_TYPE=${build_type})
run(${CMAKE_COMMAND} --build ${consumer})
run(${consumer}/consume ${prefix}/share/softgauss/robots/arm.urdf)
