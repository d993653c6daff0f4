# Configures, builds and runs a project that uses Boxwood, starting from nothing.
#   SOURCE        the project                            BUILD_FOLDER  where to build it
#   PREFIX        where Boxwood is installed, or empty   BOXWOOD       Boxwood's sources, or empty
#   CORE_ONLY     ON where PREFIX has no components      GENERATOR, COMPILER, LAUNCHER  as in the build that asks
set(common -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  # What is tested here is the build description: nothing is optimised, without symbols, kernels for few instruction sets.
  -DCMAKE_BUILD_TYPE=
  -DCMAKE_CXX_FLAGS=-DBOXWOOD_FEW_TARGETS)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(BOXWOOD AND NOT LAUNCHER)  # half of the time of compiling is reading headers; ccache does better without
  list(APPEND common -DBOXWOOD_PRECOMPILE=ON)
endif()

file(REMOVE_RECURSE ${BUILD_FOLDER})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD_FOLDER}/consumer ${common} "-DCMAKE_PREFIX_PATH=${PREFIX}"
  "-DBOXWOOD=${BOXWOOD}" -DCORE_ONLY=${CORE_ONLY})
run(${CMAKE_COMMAND} --build ${BUILD_FOLDER}/consumer)
run(${CMAKE_CTEST_COMMAND} --test-dir ${BUILD_FOLDER}/consumer --output-on-failure --no-tests=error)
