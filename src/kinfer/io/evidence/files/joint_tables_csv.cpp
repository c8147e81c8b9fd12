// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/files/joint_tables_csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/io/robot/patch/calibrated_origins.hpp"
#include "kinfer/io/text/csv_text.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

constexpr double mm = 1e-3;

const DhNumbers* dh_numbers(const Joint& joint) {
  if (const auto* dh = std::get_if<DhLink>(&joint.link)) return dh;
  return std::get_if<MdhLink>(&joint.link);
}

/// Change of a joint's zero position and its standard deviation: along the axis [m] or about it [rad].
struct Offset {
  double value = 0.0, sd = 0.0;
  bool identifiable = false;
};

const ParameterEstimate* find(const Estimate& estimate, const std::string& name) {
  for (const ParameterEstimate& p : estimate.values)
    if (p.name == name) return &p;
  return nullptr;
}

Offset dh_offset(const Estimate& estimate, const Joint& nominal, const Joint& found, std::size_t index) {
  const bool is_prismatic = translates(nominal.type);
  const DhNumbers &before = *dh_numbers(nominal), &after = *dh_numbers(found);
  const auto* p = find(estimate, fmt::format("{}{}", is_prismatic ? "d" : "theta", index + 1));
  return {is_prismatic ? after.d - before.d : after.theta - before.theta, p ? p->sd : 0.0, p && p->identifiable};
}

Offset urdf_offset(const Estimate& estimate, const Joint& nominal, const Joint& found, std::size_t index) {
  const bool is_prismatic = translates(nominal.type);
  const auto& before = std::get<UrdfLink>(nominal.link);
  Offset offset{zero_offset(nominal, found), 0.0, true};
  for (int k = 0; k < 3; ++k) {
    const auto* p = find(estimate, fmt::format("{}{}{}", is_prismatic ? "" : "r", "xyz"[k], index + 1));
    if (std::abs(before.axis[k]) < 1e-6) continue;
    offset.identifiable = offset.identifiable && p && p->identifiable;
    if (p) offset.sd = std::hypot(offset.sd, before.axis[k] * p->sd);
  }
  return offset;
}

}  // namespace

std::string format_dh_table_csv(const Chain& chain) {
  std::string text = "joint,type,theta[deg],d[mm],a[mm],alpha[deg],beta[deg],gain\n";
  for (const Joint& joint : chain.joints)
    if (const DhNumbers* row = dh_numbers(joint))
      text +=
          fmt::format("{},{},{},{},{},{},{},{}\n", csv_cell(joint.name), traits(joint.type).name,
                      format_number(row->theta, degree), format_number(row->d, mm), format_number(row->a, mm),
                      format_number(row->alpha, degree), format_number(row->beta, degree), format_number(joint.gain));
  return text;
}

std::string format_joint_twists_csv(const Chain& chain) {
  std::string text = "joint,type,wx,wy,wz,vx[mm],vy[mm],vz[mm]\n";
  const std::vector<AxisLine> lines = axis_lines(chain);
  std::size_t i = 0;
  for (const int j : path_to(chain, chain.tip_joint())) {
    const Joint& joint = chain.joints[j];
    if (!has_position(joint.type)) continue;
    const AxisLine& line = lines[i++];
    const Vec3 w = line.is_prismatic ? Vec3::Zero().eval() : line.direction;
    const Vec3 v = line.is_prismatic ? (mm * line.direction).eval() : line.point.cross(line.direction).eval();
    text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_cell(joint.name), traits(joint.type).name,
                        format_number(w.x()), format_number(w.y()), format_number(w.z()), format_number(v.x(), mm),
                        format_number(v.y(), mm), format_number(v.z(), mm));
  }
  return text;
}

std::string format_encoder_offsets_csv(const Chain& nominal, const Estimate& estimate) {
  std::string text = "joint,offset,sd,unit,identifiable\n";
  for (std::size_t j = 0; j < nominal.joints.size() && j < estimate.chain.joints.size(); ++j) {
    const Joint &before = nominal.joints[j], &after = estimate.chain.joints[j];
    if (!has_position(before.type) || before.link.index() != after.link.index()) continue;
    const Offset offset =
        dh_numbers(before) ? dh_offset(estimate, before, after, j) : urdf_offset(estimate, before, after, j);
    const bool is_prismatic = translates(before.type);
    text +=
        fmt::format("{},{},{},{},{}\n", csv_cell(before.name), format_number(offset.value, is_prismatic ? mm : degree),
                    format_number(offset.sd, is_prismatic ? mm : degree), is_prismatic ? "mm" : "deg",
                    offset.identifiable ? "yes" : "no");
  }
  return text;
}

std::string format_covariance_csv(const Estimate& estimate) {
  std::string text = "parameter";
  for (const ParameterEstimate& p : estimate.values) text += "," + csv_cell(p.name);
  text += "\n";
  for (Eigen::Index i = 0; i < estimate.covariance.rows(); ++i) {
    text += csv_cell(estimate.values[i].name);
    for (Eigen::Index k = 0; k < estimate.covariance.cols(); ++k)
      text += "," + format_number(estimate.covariance(i, k));
    text += "\n";
  }
  return text;
}

}  // namespace kinfer
