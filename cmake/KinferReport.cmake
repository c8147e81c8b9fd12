# SPDX-License-Identifier: Apache-2.0
# The front end of report.html (folder web/): bundled by esbuild and written as a source file, so that the installed program
# needs no Node. Without scripts the report still has its text, tables and drawings.
option(KINFER_REPORT_SCRIPTS "Bundle the report's scripts (3D, interactive plots); needs nodejs and npm" ON)

function(kinfer_report_bundle output)
  set(web ${PROJECT_SOURCE_DIR}/web)
  if(NOT KINFER_REPORT_SCRIPTS)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${web}/src/style.css)
    file(READ ${web}/src/style.css style)
    string(REGEX REPLACE "@import [^\n]*\n" "" style "${style}")  # style of the interactive plots
    file(CONFIGURE OUTPUT ${output} @ONLY CONTENT [[
#include "kinfer/report/bundle.hpp"

namespace kinfer::report {

std::string_view report_script() { return ""; }
std::string_view report_style() {
  return R"css(@style@)css";
}

}  // namespace kinfer::report
]])
    return()
  endif()
  # A source tarball brings the bundle, ready to compile.
  if(EXISTS ${web}/bundle.cpp)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${web}/bundle.cpp)
    configure_file(${web}/bundle.cpp ${output} COPYONLY)
    return()
  endif()
  find_program(KINFER_NODE NAMES node nodejs)
  find_program(KINFER_NPM npm)
  if(NOT KINFER_NODE OR NOT KINFER_NPM)
    message(FATAL_ERROR "The report's front end is bundled with nodejs and npm, which are missing: "
      "install them (apt-get install --no-install-recommends nodejs npm), or configure with "
      "-DKINFER_REPORT_SCRIPTS=OFF for reports without 3D.")
  endif()
  set(installed ${web}/node_modules/.package-lock.json)
  add_custom_command(OUTPUT ${installed}
    COMMAND ${KINFER_NPM} ci --silent --no-audit --no-fund --ignore-scripts
    COMMAND ${CMAKE_COMMAND} -E touch ${installed}
    DEPENDS ${web}/package.json ${web}/package-lock.json
    WORKING_DIRECTORY ${web} COMMENT "Installing the report's front-end packages" VERBATIM)
  file(GLOB sources CONFIGURE_DEPENDS ${web}/src/*.ts ${web}/src/*.css)
  add_custom_command(OUTPUT ${output}
    COMMAND ${KINFER_NODE} bundle.mjs ${output}
    DEPENDS ${installed} ${web}/bundle.mjs ${sources}
    WORKING_DIRECTORY ${web} COMMENT "Bundling the report's front end" VERBATIM)
endfunction()
