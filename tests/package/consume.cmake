# Configures, builds and runs a project that uses Boxwood, starting from nothing.
#   SOURCE        the project                            BUILD_FOLDER  where to build it
#   PREFIX        where Boxwood is installed, or empty   BOXWOOD       Boxwood's sources, or empty
#   GENERATOR, COMPILER, LAUNCHER                        as in the build that asks
# With both PREFIX and BOXWOOD, the core is first built as a shared library and installed into PREFIX.
set(common -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  -DCMAKE_BUILD_TYPE=Debug
  # What is tested here is the build description, so the kernels are compiled for few instruction sets.
  -DCMAKE_CXX_FLAGS=-DBOXWOOD_FEW_TARGETS)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${BUILD_FOLDER})
if(PREFIX AND BOXWOOD)
  file(REMOVE_RECURSE ${PREFIX})
  set(core ${BUILD_FOLDER}/core)
  run(${CMAKE_COMMAND} -S ${BOXWOOD} -B ${core} ${common} -DBUILD_SHARED_LIBS=ON -DBOXWOOD_IO=OFF -DBOXWOOD_RENDER=OFF
    -DBOXWOOD_APPS=OFF -DBOXWOOD_TESTS=OFF -DBOXWOOD_EXAMPLES=OFF)
  run(${CMAKE_COMMAND} --build ${core})
  run(${CMAKE_COMMAND} --install ${core} --prefix ${PREFIX})
  list(APPEND common -DCORE_ONLY=ON)
endif()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD_FOLDER}/consumer ${common} "-DCMAKE_PREFIX_PATH=${PREFIX}"
  "-DBOXWOOD=${BOXWOOD}")
run(${CMAKE_COMMAND} --build ${BUILD_FOLDER}/consumer)
run(${CMAKE_CTEST_COMMAND} --test-dir ${BUILD_FOLDER}/consumer --output-on-failure --no-tests=error)
