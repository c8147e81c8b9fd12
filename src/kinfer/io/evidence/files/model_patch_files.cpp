// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/files/model_patch_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "kinfer/base/constants.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/patch/joint_origins_yaml.hpp"
#include "kinfer/io/robot/patch/mjcf_patch.hpp"
#include "kinfer/io/robot/patch/placement_toml.hpp"
#include "kinfer/io/robot/patch/urdf_patch.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/text/csv_text.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

constexpr double same_pose = 1e-9;  // [m], [1] between the calibrated chain and the file that is written
constexpr double millimetre = 1e-3;

/// Joint positions of the rows, or zeros where there are none.
MatrixXd evaluated_positions(const Calibration& calibration, const Chain& chain) {
  const MatrixXd& rows = calibration.plot_data.joints;
  if (rows.rows() == dof(chain) && rows.cols() > 0) return rows;
  return MatrixXd::Zero(dof(chain), 1);
}

/// Joint positions by the offsets that were kept out of the file.
VectorXd with_offsets(const Chain& chain, VectorXd q, const std::vector<CalibratedOrigin>& origins) {
  const std::vector<int> joints = active_joints(chain);
  for (std::size_t k = 0; k < joints.size(); ++k)
    for (const CalibratedOrigin& origin : origins)
      if (origin.joint == chain.joints[joints[k]].name) q[static_cast<Eigen::Index>(k)] += origin.offset;
  return q;
}

Result<void> expect_same_poses(const Chain& written, const Chain& corrected, const MatrixXd& positions,
                               const std::vector<CalibratedOrigin>& origins) {
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    const Pose expected = forward(corrected, positions.col(i));
    const Pose found = forward(written, with_offsets(corrected, positions.col(i), origins));
    const double distance = (expected.position - found.position).norm();
    if (!(distance < same_pose) || !((expected.rotation - found.rotation).cwiseAbs().maxCoeff() < same_pose))
      return error("the robot file with the calibrated origins differs from the calibrated chain by {:.3g} m",
                   distance);
  }
  return {};
}

/// The links at the ends of the chain.
ChainEnds chain_ends(const Chain& chain, const UrdfJointPositions& joints) {
  const UrdfJointPosition *first = joints.find(chain.joints.front().name),
                          *last = joints.find(chain.joints[chain.tip_joint()].name);
  return {first ? first->parent_link : "", last ? last->child_link : ""};
}

/// What was written, as it reads.
struct WrittenFile {
  PatchedText patched;
  Chain chain;
  ChainEnds ends;
  std::optional<UrdfJointPositions> urdf_joints{};
};

Result<WrittenFile> patch_urdf_file(const RobotSource& source, const Chain& corrected,
                                    const std::vector<CalibratedOrigin>& origins) {
  KINFER_TRY(patched, patch_urdf(source.text, source.name, origins));
  KINFER_TRY(joints, locate_urdf_joints(patched.text, source.name));
  KINFER_TRY(chain, parse_urdf(patched.text, source.name, source.ends));
  const ChainEnds ends = chain_ends(corrected, joints);
  return WrittenFile{std::move(patched), std::move(chain), ends, std::move(joints)};
}

Result<WrittenFile> patch_mjcf_file(const RobotSource& source, const std::vector<CalibratedOrigin>& origins) {
  KINFER_TRY(tree, parse_mjcf_tree(source.text, source.name));
  KINFER_TRY(ends, mjcf_ends(tree, source.name, source.ends));
  KINFER_TRY(patched, patch_mjcf(source.text, source.name, ends, origins));
  KINFER_TRY(chain, parse_mjcf(patched.text, source.name, ends));
  return WrittenFile{std::move(patched), std::move(chain), std::move(ends)};
}

/// Numbers for those who generate their robot file.
std::vector<OutputFile> joint_tables(const WrittenFile& file, const ModelPatch& patch) {
  std::vector<OutputFile> files;
  if (!file.urdf_joints) {
    if (patch.offsets == EncoderOffsets::separate)
      files.push_back({"joint_offsets.yaml", format_joint_offsets_yaml(patch)});
    return files;
  }
  files.push_back({"joint_origins.yaml", format_joint_origins_yaml(*file.urdf_joints, patch)});
  if (auto kinematics = format_kinematics_yaml(*file.urdf_joints))
    files.push_back({"kinematics.yaml", std::move(*kinematics)});
  return files;
}

std::string calibrated_name(const std::string& name) {
  const std::filesystem::path path(name);
  return path.stem().string() + "_calibrated" + path.extension().string();
}

}  // namespace

Result<PatchedModel> patch_model(const RobotModel& robot, const Calibration& calibration, EncoderOffsets offsets) {
  const RobotSource& source = robot.source.value();
  const Chain corrected = corrected_chain(calibration);
  KINFER_TRY(origins, calibrated_origins(robot.chain, corrected, offsets));
  KINFER_TRY(file, source.format == RobotFileFormat::urdf ? patch_urdf_file(source, corrected, origins)
                                                          : patch_mjcf_file(source, origins));
  const MatrixXd positions = evaluated_positions(calibration, corrected);
  const GeometricPart geometric = geometric_part(corrected, robot.chain, positions);
  file.chain.base = corrected.base, file.chain.tool = corrected.tool;
  if (auto same = expect_same_poses(file.chain, geometric.chain, positions, origins); !same)
    return forward_error(same.error());

  PatchedModel model;
  model.patch = {.file = calibrated_name(source.name),
                 .format = source.format,
                 .offsets = offsets,
                 .changes = std::move(file.patched.changes),
                 .omitted = geometric.differences,
                 .omitted_rms = geometric.rms,
                 .omitted_max = geometric.max};
  StandardDeviations sd;
  for (const ParameterEstimate& p : calibration.estimate.values) sd[p.name] = p.sd;
  model.files = {{model.patch.file, std::move(file.patched.text)},
                 {"model_changes.csv", format_model_changes_csv(model.patch)},
                 {"placement.toml", format_placement_toml(corrected, file.ends, sd)}};
  for (OutputFile& table : joint_tables(file, model.patch)) model.files.push_back(std::move(table));
  return model;
}

std::string format_model_changes_csv(const ModelPatch& patch) {
  std::string text = "joint,line,dx[mm],dy[mm],dz[mm],rx[deg],ry[deg],rz[deg],offset,unit\n";
  for (const OriginChange& change : patch.changes) {
    text += fmt::format("{},{}", csv_cell(change.joint), change.line);
    for (const double x : change.translation) text += "," + format_number(x, millimetre);
    for (const double x : change.rotation_vector) text += "," + format_number(x, degree);
    text += fmt::format(",{},{}\n", format_number(change.offset, change.translates ? millimetre : degree),
                        change.translates ? "mm" : "deg");
  }
  return text;
}

}  // namespace kinfer
