# SPDX-License-Identifier: Apache-2.0
# Writes a source file that holds the MJCF files of `folder` as string literals; rewritten when one of them changes.
function(kinfer_embed_machines folder output)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*.xml)
  set(entries "")
  foreach(file ${files})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME_WE)
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"mjcf(${text})mjcf\"},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${output} @ONLY CONTENT [[
#include "kinfer/simulate/machine_files.hpp"

namespace kinfer {
namespace {
constexpr MachineFile files[] = {
@entries@};
}  // namespace

std::span<const MachineFile> machine_files() { return files; }

}  // namespace kinfer
]])
endfunction()
