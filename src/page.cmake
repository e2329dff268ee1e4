# The report's page in one object file: the libraries that Debian packages, and our own files of report/page.
set(COUNTERFLEX_JAVASCRIPT_DIR /usr/share/javascript CACHE PATH
    "Where dygraphs/ and three/ are (Debian's libjs-dygraphs and libjs-three)")

set(page_folder ${CMAKE_CURRENT_SOURCE_DIR}/report/page)
set(page_template ${page_folder}/page.html)
set(page_styles ${COUNTERFLEX_JAVASCRIPT_DIR}/dygraphs/dygraph.min.css ${page_folder}/page.css
    ${page_folder}/scene/scene.css)
set(page_scripts ${COUNTERFLEX_JAVASCRIPT_DIR}/dygraphs/dygraph.min.js ${COUNTERFLEX_JAVASCRIPT_DIR}/three/three.min.js)
file(STRINGS ${page_folder}/scripts.txt own_scripts)
list(TRANSFORM own_scripts PREPEND ${page_folder}/)
list(APPEND page_scripts ${own_scripts})

# The texts of files as one list of raw string literals.
function(counterflex_literals result)
  set(literals "")
  foreach(file IN LISTS ARGN)
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "${file} is missing; Debian's libjs-dygraphs and libjs-three have the libraries of the report's page")
    endif()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    # In a page none of these may stand in a script or a style.
    if(text MATCHES "</[sS][cC][rR][iI][pP][tT]|</[sS][tT][yY][lL][eE]|<!--" AND NOT file MATCHES "\\.html$")
      message(FATAL_ERROR "${file} holds the end of an element of the page, ${CMAKE_MATCH_0}")
    endif()
    string(APPEND literals "R\"counterflex_page(${text})counterflex_page\"sv, ")
  endforeach()
  string(REGEX REPLACE ", $" "" literals "${literals}")
  set(${result} "${literals}" PARENT_SCOPE)
endfunction()

counterflex_literals(counterflex_page_template ${page_template})
counterflex_literals(counterflex_page_styles ${page_styles})
counterflex_literals(counterflex_page_scripts ${page_scripts})
counterflex_literals(counterflex_sheet_style ${page_folder}/sheet.css)
list(LENGTH page_styles counterflex_page_style_count)
list(LENGTH page_scripts counterflex_page_script_count)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page_folder}/scripts.txt)
configure_file(report/page_assets.cpp.in report/page_assets.cpp @ONLY)
target_sources(counterflex_report PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/report/page_assets.cpp)
set_source_files_properties(${CMAKE_CURRENT_BINARY_DIR}/report/page_assets.cpp PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
