// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/mujoco_library.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

Error missing_library(const std::string& why) {
  return {fmt::format("MuJoCo is needed to simulate machines, and {}; install it (Debian: apt install {})", why,
                      KINFER_MUJOCO_PACKAGE)};
}

/// Sets `place` to the symbol of that name; false if the library has none.
template <class Pointer>
bool take_symbol(void* library, const char* name, Pointer& place) {
  place = reinterpret_cast<Pointer>(dlsym(library, name));
  return place != nullptr;
}

Result<MujocoLibrary> open_mujoco() {
  const char* named = std::getenv("KINFER_MUJOCO");
  const std::string file = named && *named ? named : KINFER_MUJOCO_SONAME;
  // Never closed: the callbacks that are set in it stay until the process ends.
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) return forward_error(missing_library(fmt::format("{} cannot be loaded", file)));
  int (*version)() = nullptr;
  if (!take_symbol(library, "mj_version", version) || version() != mjVERSION_HEADER)
    return forward_error(missing_library(fmt::format("{} is not of version {}", file, mjVERSION_HEADER)));
  MujocoLibrary m;
  bool complete = take_symbol(library, "mjcb_control", m.mjcb_control) &&
                  take_symbol(library, "mju_user_warning", m.mju_user_warning);
  complete = complete && take_symbol(library, "mj_copyModel", m.mj_copyModel);
  complete = complete && take_symbol(library, "mj_defaultVFS", m.mj_defaultVFS);
  complete = complete && take_symbol(library, "mj_deleteData", m.mj_deleteData);
  complete = complete && take_symbol(library, "mj_deleteModel", m.mj_deleteModel);
  complete = complete && take_symbol(library, "mj_deleteVFS", m.mj_deleteVFS);
  complete = complete && take_symbol(library, "mj_forward", m.mj_forward);
  complete = complete && take_symbol(library, "mj_fullM", m.mj_fullM);
  complete = complete && take_symbol(library, "mj_id2name", m.mj_id2name);
  complete = complete && take_symbol(library, "mj_inverse", m.mj_inverse);
  complete = complete && take_symbol(library, "mj_loadXML", m.mj_loadXML);
  complete = complete && take_symbol(library, "mj_makeData", m.mj_makeData);
  complete = complete && take_symbol(library, "mj_makeEmptyFileVFS", m.mj_makeEmptyFileVFS);
  complete = complete && take_symbol(library, "mj_mulM", m.mj_mulM);
  complete = complete && take_symbol(library, "mj_resetDataKeyframe", m.mj_resetDataKeyframe);
  complete = complete && take_symbol(library, "mj_step", m.mj_step);
  complete = complete && take_symbol(library, "mju_mat2Quat", m.mju_mat2Quat);
  if (!complete) return forward_error(missing_library(fmt::format("{} is incomplete", file)));
  return m;
}

const Result<MujocoLibrary>& opened_mujoco() {
  static const Result<MujocoLibrary> library = open_mujoco();
  return library;
}

}  // namespace

Result<void> load_mujoco() {
  if (!opened_mujoco()) return forward_error(opened_mujoco().error());
  return {};
}

const MujocoLibrary& mujoco() {
  KINFER_EXPECT(opened_mujoco().has_value(), "load_mujoco() comes first");
  return *opened_mujoco();
}

}  // namespace kinfer
