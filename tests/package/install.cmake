# Installs a finished build tree into an empty prefix: cmake -DBUILD_TREE= -DPREFIX= -P install.cmake
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_TREE} --prefix ${PREFIX} COMMAND_ERROR_IS_FATAL ANY)
