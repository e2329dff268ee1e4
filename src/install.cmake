# `cmake --install` and, from it, `find_package(counterflex)` with one target a module: counterflex::statics ...
include(CMakePackageConfigHelpers)

get_property(modules DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/counterflex)

install(TARGETS ${modules} EXPORT counterflex ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/counterflex DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT counterflex NAMESPACE counterflex:: FILE counterflex-targets.cmake DESTINATION ${package_dir})

configure_package_config_file(counterflex-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/counterflex-config.cmake
  INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/counterflex-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/counterflex-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/counterflex-config-version.cmake DESTINATION ${package_dir})
