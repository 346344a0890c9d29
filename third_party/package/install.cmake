# What `cmake --install` puts where, for programs that embed gestus: the three libraries, their
# headers, a CMake package (find_package(gestus), target gestus::models) and a pkg-config file.
include(CMakePackageConfigHelpers)

foreach(layer kernels engine models)
  set_target_properties(gestus_${layer} PROPERTIES EXPORT_NAME ${layer})
endforeach()
install(TARGETS gestus_kernels gestus_engine gestus_models EXPORT gestus
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES kernels/kernels.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gestus/kernels)
file(GLOB headers RELATIVE ${CMAKE_SOURCE_DIR} engine/*.h models/*.h models/*/*.h)
list(FILTER headers EXCLUDE REGEX "^models/cli/")
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
configure_file(third_party/package/gestus.pc.in ${CMAKE_BINARY_DIR}/gestus.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/gestusConfig.cmake ${CMAKE_BINARY_DIR}/gestusConfigVersion.cmake
        DESTINATION ${package})
install(FILES ${CMAKE_BINARY_DIR}/gestus.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
