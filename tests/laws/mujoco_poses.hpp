// SPDX-License-Identifier: Apache-2.0
// Where MuJoCo has bodies and sites at given joint positions.
#pragma once

#include "kinfer/geometry/pose.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "laws/mujoco_model.hpp"

namespace kinfer::laws {

/// Sets joint positions by name; joints that an <equality> ties to others follow.
inline void set_positions(const mjModel& model, mjData& data, const std::vector<std::string>& names,
                          const VectorXd& q) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    const int joint = mj_name2id(&model, mjOBJ_JOINT, names[k].c_str());
    ASSERT_GE(joint, 0) << names[k];
    data.qpos[model.jnt_qposadr[joint]] = q[static_cast<Eigen::Index>(k)];
  }
  for (int pass = 0; pass < model.neq; ++pass)  // a leader may follow another joint
    for (int e = 0; e < model.neq; ++e) {
      if (model.eq_type[e] != mjEQ_JOINT || !model.eq_active[e]) continue;
      const int follower = model.jnt_qposadr[model.eq_obj1id[e]], leader = model.eq_obj2id[e];
      const mjtNum* coefficients = model.eq_data + e * mjNEQDATA;
      double position = model.qpos0[follower] + coefficients[0];
      if (leader >= 0) {
        const int address = model.jnt_qposadr[leader];
        position += coefficients[1] * (data.qpos[address] - model.qpos0[address]);
      }
      data.qpos[follower] = position;
    }
  mj_kinematics(&model, &data);
}

inline Pose pose_at(const mjtNum* position, const mjtNum* rotation) {
  return {Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation), Vec3(position)};
}

/// world_T_body or world_T_site, whichever has the name.
inline Pose pose_of(const mjModel& model, const mjData& data, const std::string& name) {
  if (const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str()); body >= 0)
    return pose_at(data.xpos + 3 * body, data.xmat + 9 * body);
  const int site = mj_name2id(&model, mjOBJ_SITE, name.c_str());
  EXPECT_GE(site, 0) << name;
  return pose_at(data.site_xpos + 3 * site, data.site_xmat + 9 * site);
}

}  // namespace kinfer::laws
