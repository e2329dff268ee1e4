# What `find_package` finds in a build for Windows: libraries that are compiled from Debian's source packages, and headers.
set(COUNTERFLEX_WINDOWS_PACKAGES ${CMAKE_BINARY_DIR}/packages)
execute_process(COMMAND ${CMAKE_CURRENT_LIST_DIR}/prepare ${COUNTERFLEX_WINDOWS_PACKAGES} COMMAND_ERROR_IS_FATAL ANY)

function(counterflex_windows_headers name)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${name} INTERFACE ${COUNTERFLEX_WINDOWS_PACKAGES}/headers)
endfunction()

# The library `name` of the sources that match, with the headers of the folders INCLUDES.
function(counterflex_windows_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;INCLUDES;DEFINES" ${ARGN})
  list(TRANSFORM arg_SOURCES PREPEND ${COUNTERFLEX_WINDOWS_PACKAGES}/)
  list(TRANSFORM arg_INCLUDES PREPEND ${COUNTERFLEX_WINDOWS_PACKAGES}/)
  file(GLOB sources ${arg_SOURCES})
  add_library(${name} STATIC EXCLUDE_FROM_ALL ${sources})
  target_include_directories(${name} SYSTEM PUBLIC ${arg_INCLUDES})
  target_compile_definitions(${name} PUBLIC ${arg_DEFINES})
  target_compile_options(${name} PRIVATE -w)
endfunction()

macro(counterflex_windows_package method name)
  set(counterflex_found TRUE)
  if("${name}" STREQUAL fmt)
    if(NOT TARGET fmt::fmt)
      counterflex_windows_library(fmt SOURCES fmtlib/src/format.cc INCLUDES headers)
      add_library(fmt::fmt ALIAS fmt)
    endif()
  elseif("${name}" STREQUAL nlohmann_json)
    if(NOT TARGET nlohmann_json::nlohmann_json)
      counterflex_windows_headers(nlohmann_json::nlohmann_json)
    endif()
  elseif("${name}" STREQUAL CLI11)
    counterflex_windows_headers(CLI11::CLI11)
  elseif("${name}" STREQUAL tomlplusplus)
    counterflex_windows_headers(tomlplusplus::tomlplusplus)
  elseif("${name}" STREQUAL yaml-cpp)
    counterflex_windows_library(yaml-cpp SOURCES yaml-cpp/src/*.cpp INCLUDES yaml-cpp/include DEFINES YAML_CPP_STATIC_DEFINE)
  elseif("${name}" STREQUAL urdfdom)
    counterflex_windows_library(urdfdom_model
      SOURCES urdfdom/urdf_parser/src/model.cpp urdfdom/urdf_parser/src/link.cpp urdfdom/urdf_parser/src/joint.cpp
              urdfdom/urdf_parser/src/pose.cpp tinyxml/tiny*.cpp console-bridge/src/console.cpp
      INCLUDES headers urdfdom/urdf_parser/include tinyxml console-bridge/include
      DEFINES TIXML_USE_STL URDFDOM_STATIC CONSOLE_BRIDGE_STATIC_DEFINE)
    add_library(urdfdom::urdfdom_model ALIAS urdfdom_model)
  else()  # Eigen, whose headers have a folder of their own, threads
    find_package(${name} ${ARGN} BYPASS_PROVIDER)
    set(counterflex_found ${${name}_FOUND})
  endif()
  set(${name}_FOUND ${counterflex_found})
endmacro()
cmake_language(SET_DEPENDENCY_PROVIDER counterflex_windows_package SUPPORTED_METHODS FIND_PACKAGE)
