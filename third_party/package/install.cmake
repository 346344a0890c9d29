# What `cmake --install` puts where, for programs that embed gestus: the libraries, their
# headers, a CMake package (find_package(gestus), targets gestus::models and gestus::text) and
# pkg-config files.
include(CMakePackageConfigHelpers)

set(libraries kernels engine models)
if(TARGET gestus_text)
  list(APPEND libraries text)
endif()
foreach(library IN LISTS libraries)
  set_target_properties(gestus_${library} PROPERTIES EXPORT_NAME ${library})
  install(TARGETS gestus_${library} EXPORT gestus ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
install(FILES kernels/kernels.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gestus/kernels)
file(GLOB headers RELATIVE ${CMAKE_SOURCE_DIR} engine/*.h models/*.h models/*/*.h)
list(FILTER headers EXCLUDE REGEX "^models/cli/")
if(NOT TARGET gestus_text)
  list(FILTER headers EXCLUDE REGEX "^models/text/")
endif()
foreach(header ${headers})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gestus/${folder})
endforeach()

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/gestus)
install(EXPORT gestus NAMESPACE gestus:: FILE gestusTargets.cmake DESTINATION ${package})
configure_package_config_file(third_party/package/gestusConfig.cmake.in
                              ${CMAKE_BINARY_DIR}/gestusConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/gestusConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/gestusConfig.cmake ${CMAKE_BINARY_DIR}/gestusConfigVersion.cmake
        DESTINATION ${package})

# gestus-text is apart, so that who wants the networks alone needs no libutf8proc.
set(pkgconfig_files gestus)
if(TARGET gestus_text)
  list(APPEND pkgconfig_files gestus-text)
endif()
foreach(name IN LISTS pkgconfig_files)
  configure_file(third_party/package/${name}.pc.in ${CMAKE_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
