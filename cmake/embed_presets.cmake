# SPDX-License-Identifier: Apache-2.0
# Writes a source file that holds the TOML files of `folder` as string literals; rewritten when one of them changes.
function(kinfer_embed_presets folder output)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*.toml)
  set(entries "")
  foreach(file ${files})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME_WE)
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"preset(${text})preset\"},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${output} @ONLY CONTENT [[
#include "kinfer/io/recording/foreign/preset_files.hpp"

namespace kinfer {
namespace {
constexpr PresetFile preset_list[] = {
@entries@};
}  // namespace

std::span<const PresetFile> preset_files() { return preset_list; }

}  // namespace kinfer
]])
endfunction()
