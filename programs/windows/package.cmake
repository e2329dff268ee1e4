# `cmake --build --preset windows --target package`: a zip with the program, the guide, the samples, the hook for
# post-processors, and the licences of what the program contains.
install(TARGETS counterflex RUNTIME DESTINATION .)
# README.md and the guide refer to each other and to the samples as in the source.
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION .)
install(DIRECTORY guide/ DESTINATION programs/guide FILES_MATCHING PATTERN *.md PATTERN *.svg)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/samples DESTINATION .)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/samples/pipeline/post_hook.cmd DESTINATION .)

install(FILES package/copyright DESTINATION licences RENAME counterflex.txt)
foreach(source fmtlib yaml-cpp urdfdom tinyxml console-bridge)
  install(FILES ${COUNTERFLEX_WINDOWS_PACKAGES}/${source}/debian/copyright DESTINATION licences RENAME ${source}.txt)
endforeach()
foreach(package libeigen3-dev nlohmann-json3-dev libcli11-dev libtomlplusplus-dev liburdfdom-headers-dev libjs-dygraphs libjs-three
        gcc-mingw-w64-base mingw-w64-x86-64-dev)
  install(FILES /usr/share/doc/${package}/copyright DESTINATION licences RENAME ${package}.txt)
endforeach()

set(CPACK_GENERATOR ZIP)
set(CPACK_PACKAGE_NAME counterflex)
set(CPACK_PACKAGE_FILE_NAME counterflex-${PROJECT_VERSION}-windows-x86_64)
set(CPACK_STRIP_FILES ON)
include(CPack)
