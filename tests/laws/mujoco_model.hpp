// SPDX-License-Identifier: Apache-2.0
// MJCF text compiled by MuJoCo.
#pragma once

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <string>

namespace kinfer::laws {

struct MujocoFree {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

inline std::unique_ptr<mjModel, MujocoFree> mujoco_model(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "machine.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char why[1000] = "";
  std::unique_ptr<mjModel, MujocoFree> model(mj_loadXML("machine.xml", files.get(), why, sizeof why));
  EXPECT_TRUE(model) << why << "\n" << xml;
  mj_deleteVFS(files.get());
  return model;
}

}  // namespace kinfer::laws
