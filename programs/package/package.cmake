# `cmake --build --preset release --target package`: a Debian package of what `cmake --install` installs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME counterflex)
set(CPACK_PACKAGE_VENDOR counterflex)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "corrects machining programs for the elastic machine that runs them")
set(CPACK_PACKAGE_DESCRIPTION
"Counterflex reads a machining program, the cutting forces and an elastostatic
model of the machine. It writes the program whose execution on the real
machine, imperfectly assembled, loaded and elastic, follows the programmed
path, with a report of the deviation before and after.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "Counterflex <counterflex@example.org>" CACHE STRING "Name <address> of who maintains the Debian package")
# What the library's headers and its CMake package need; the program needs none of it.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "cmake, libeigen3-dev, libfmt-dev, libssl-dev, libtomlplusplus-dev, liburdfdom-dev, libyaml-cpp-dev, nlohmann-json3-dev, parallel, slurm-client")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# Debian wants manual pages and changes compressed, without a date in them.
set(package_doc ${CMAKE_INSTALL_DATADIR}/doc/counterflex)
set(package_changes ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz)
configure_file(package/changelog.in ${CMAKE_CURRENT_BINARY_DIR}/changelog @ONLY)
add_custom_command(OUTPUT ${package_changes} DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/changelog
  COMMAND gzip -9nc ${CMAKE_CURRENT_BINARY_DIR}/changelog >${package_changes})
set(package_man ${CMAKE_CURRENT_BINARY_DIR}/counterflex.1.gz)
add_custom_command(OUTPUT ${package_man} DEPENDS counterflex.1
  COMMAND gzip -9nc ${CMAKE_CURRENT_SOURCE_DIR}/counterflex.1 >${package_man})
add_custom_target(counterflex_package_files ALL DEPENDS ${package_changes} ${package_man})
install(FILES ${package_man} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${package_changes} package/copyright DESTINATION ${package_doc})


include(CPack)
