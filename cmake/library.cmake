# boxwood_add_library(TARGET EXPORTED STAGE...): a library from src/STAGE/**.cpp whose public headers are
# include/boxwood/STAGE.h, known to users as boxwood::EXPORTED both in this tree and after installation.
# Sources are globbed so that adding an algorithm needs no edit here.
function(boxwood_add_library target exported)
  set(sources)
  set(headers)
  foreach(stage IN LISTS ARGN)
    file(GLOB_RECURSE stage_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${stage}/*.cpp)
    list(APPEND sources ${stage_sources})
    if(EXISTS ${PROJECT_SOURCE_DIR}/include/boxwood/${stage}.h)
      list(APPEND headers ${PROJECT_SOURCE_DIR}/include/boxwood/${stage}.h)
    endif()
  endforeach()
  add_library(${target} ${sources})
  add_library(boxwood::${exported} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${exported} VERIFY_INTERFACE_HEADER_SETS ON
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${headers})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(${target} PUBLIC cxx_std_20)
  boxwood_compile_options(${target})
  boxwood_precompile(${target} ${boxwood_common_headers})
endfunction()

# What nearly every source includes: reading these takes longer than most sources themselves. Only other people's
# headers: with ours, every change of one would compile everything. Sources still include all that they use.
set(boxwood_common_headers <algorithm> <array> <cmath> <cstdint> <cstring> <functional> <limits> <memory> <optional>
  <span> <string> <string_view> <utility> <vector>)

# boxwood_precompile(TARGET HEADER...) or boxwood_precompile(TARGET REUSE_FROM OTHER)
function(boxwood_precompile target)
  if(NOT BOXWOOD_PRECOMPILE)
    return()
  elseif(ARGV1 STREQUAL "REUSE_FROM")
    target_precompile_headers(${target} REUSE_FROM ${ARGV2})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# Options of every target of this project, users of the library not included.
function(boxwood_compile_options target)
  # Without contraction a * b + c rounds twice everywhere, so results do not depend on the instruction set.
  target_compile_options(${target} PRIVATE -Wall -Wextra -ffp-contract=off $<$<CONFIG:Release>:-O3>)
  # g++ 12 warns of every "text" + std::string, wrongly.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
    if(BOXWOOD_PRECOMPILE)  # and in another way with precompiled headers
      target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
  endif()
endfunction()
