// SPDX-License-Identifier: Apache-2.0
// MuJoCo's functions, taken from its shared library when a machine is simulated: whoever only identifies and calibrates
// need not have it installed.
#pragma once

#include <mujoco/mujoco.h>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// One pointer for each function and variable of the engine that is used, under its own name.
struct MujocoLibrary {
  decltype(&::mj_copyModel) mj_copyModel = nullptr;
  decltype(&::mj_defaultVFS) mj_defaultVFS = nullptr;
  decltype(&::mj_deleteData) mj_deleteData = nullptr;
  decltype(&::mj_deleteModel) mj_deleteModel = nullptr;
  decltype(&::mj_deleteVFS) mj_deleteVFS = nullptr;
  decltype(&::mj_forward) mj_forward = nullptr;
  decltype(&::mj_fullM) mj_fullM = nullptr;
  decltype(&::mj_id2name) mj_id2name = nullptr;
  decltype(&::mj_inverse) mj_inverse = nullptr;
  decltype(&::mj_loadXML) mj_loadXML = nullptr;
  decltype(&::mj_makeData) mj_makeData = nullptr;
  decltype(&::mj_makeEmptyFileVFS) mj_makeEmptyFileVFS = nullptr;
  decltype(&::mj_mulM) mj_mulM = nullptr;
  decltype(&::mj_resetDataKeyframe) mj_resetDataKeyframe = nullptr;
  decltype(&::mj_step) mj_step = nullptr;
  decltype(&::mju_mat2Quat) mju_mat2Quat = nullptr;
  mjfGeneric* mjcb_control = nullptr;                ///< variable of the library: called in every step
  void (**mju_user_warning)(const char*) = nullptr;  ///< variable of the library: receives its warnings
};

/// Loads the library once for the process. An error where it is missing, or of another version than the one that this
/// program was compiled for: the layout of its structs differs then. The environment variable KINFER_MUJOCO names
/// another file than the system's.
Result<void> load_mujoco();

/// The functions; only after load_mujoco() was successful.
const MujocoLibrary& mujoco();

}  // namespace kinfer
