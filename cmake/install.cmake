# Installation: one export set per library, so that users of the core need not have what boxwood::io needs.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/boxwood)
set(export_boxwood core)
set(export_boxwood_io io)
set(export_boxwood_render render)
foreach(library boxwood boxwood_io boxwood_render)
  if(TARGET ${library})
    install(TARGETS ${library} EXPORT boxwood-${export_${library}}
      RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
      LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
      FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(EXPORT boxwood-${export_${library}} NAMESPACE boxwood:: FILE boxwood-${export_${library}}.cmake
      DESTINATION ${package_folder})
  endif()
endforeach()

# A shared library lies beside the program's folder.
if(TARGET boxwood_program)
  file(RELATIVE_PATH libraries_from_program ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(boxwood_program PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries_from_program}")
endif()

# Static libraries leave it to the user's linker to find what they use.
get_target_property(library_type boxwood TYPE)
if(library_type STREQUAL "STATIC_LIBRARY")
  set(BOXWOOD_IS_STATIC ON)
else()
  set(BOXWOOD_IS_STATIC OFF)
endif()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/boxwood-config.cmake.in
  ${PROJECT_BINARY_DIR}/boxwood-config.cmake INSTALL_DESTINATION ${package_folder})
# Before 1.0 each minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/boxwood-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/boxwood-config.cmake ${PROJECT_BINARY_DIR}/boxwood-config-version.cmake
  DESTINATION ${package_folder})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
