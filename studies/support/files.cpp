// SPDX-License-Identifier: Apache-2.0
#include "studies/support/files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"

namespace kinfer::study {
namespace {

/// All numbers of a line, whatever separates them.
std::vector<double> numbers_in(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  std::vector<double> numbers;
  for (double value; words >> value;) numbers.push_back(value);
  return numbers;
}

std::vector<std::vector<double>> number_rows(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);)
    if (auto numbers = numbers_in(line); !numbers.empty()) rows.push_back(std::move(numbers));
  return rows;
}

void append_row(PoseSet& set, const std::vector<double>& numbers, int dof) {
  const Eigen::Index row = set.rows();
  set.joints.conservativeResize(dof, row + 1);
  for (int k = 0; k < dof; ++k) set.joints(k, row) = numbers[k];
  set.line.push_back(static_cast<int>(row) + 1);
}

void append_pose(PoseSet& set, const Vec3& position, const Quat& orientation) {
  const int row = static_cast<int>(set.rows()) - 1;
  set.points.push_back({row, -1, position, {}});
  set.orientations.push_back({row, orientation.normalized(), {}});
}

Joint dh(double a, double alpha_deg, double d, int parent) {
  Joint joint;
  MdhLink link;
  link.a = a, link.alpha = alpha_deg * degree, link.d = d;
  joint.link = link, joint.parent = parent, joint.name = "J" + std::to_string(parent + 2);
  return joint;
}

}  // namespace

Chain ur10_chain() {
  return read_robot_toml(std::filesystem::path(KINFER_SOURCE_DIR) / "data/ur10/robot.toml")->chain;
}

PoseSet ur10_series(const std::string& folder, const std::string& file, const Chain& chain) {
  auto map = read_column_map(std::filesystem::path(KINFER_SOURCE_DIR) / "data/ur10/leica_columns.toml").value();
  const std::string path = folder + "/ur10_leica/" + file;
  std::string head;
  std::getline(std::ifstream(path), head);
  if (head.find("measurement_std_x") == std::string::npos)  // series A has no standard deviations
    std::erase_if(map.columns, [](const auto& column) { return column.first.starts_with('s'); });
  return read_pose_set(path, chain, map).value();
}

Chain mukca_chain(const std::string& folder) {
  return read_urdf(folder + "/mukca/urdf/panda.urdf", {.base_link = "panda_link0", .tip_link = "ball_link"}).value();
}

PoseSet mukca_rows(const std::string& folder, const std::string& arm, const std::vector<std::string>& positions,
                   const Chain& chain) {
  PoseSet set;
  set.joint_names = active_joint_names(chain);
  for (const std::string& position : positions)
    for (const char* hole : {"hole_0", "hole_1"}) {
      const int socket = static_cast<int>(set.sockets.size());
      set.sockets.push_back(position + "/" + hole);
      for (const auto& q : number_rows(folder + "/mukca/data/" + arm + "/" + position + "/" + hole + ".csv")) {
        append_row(set, q, 7);
        set.contacts.push_back({static_cast<int>(set.rows()) - 1, socket});
      }
    }
  return set;
}

Chain positioner_chain() {
  Chain chain;
  chain.name = "positioner";
  chain.joints = {dh(0, 0, 0, -1), dh(0, 90, 0, 0)};
  return chain;
}

PoseSet positioner_rows(const std::string& folder, const Chain& chain) {
  PoseSet set;
  set.joint_names = active_joint_names(chain);
  std::ifstream file(folder + "/positioner_2axis/measurements.yaml");
  double pose[7] = {};  // qw qx qy qz x y z, in the order of the file
  int seen = 0;
  std::vector<double> joints;
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.find("  - ") == 0) joints.push_back(std::stod(line.substr(4)));
    if (line.find("    ") == 0 && colon != std::string::npos) pose[seen++ % 7] = std::stod(line.substr(colon + 2));
    if (joints.size() < 2) continue;
    append_row(set, joints, 2);
    append_pose(set, Vec3(pose[4], pose[5], pose[6]), Quat(pose[0], pose[1], pose[2], pose[3]));
    joints.clear();
  }
  return set;
}

Chain fr3_chain() {
  Chain chain;
  chain.name = "FR3";
  chain.joints = {dh(0, 0, 0.333, -1),        dh(0, -90, 0, 0), dh(0, 90, 0.316, 1),    dh(0.0825, 90, 0, 2),
                  dh(-0.0825, -90, 0.384, 3), dh(0, 90, 0, 4),  dh(0.088, 90, 0.107, 5)};
  return chain;
}

PoseSet fr3_rows(const std::string& folder, const Chain& chain) {
  PoseSet set;
  set.joint_names = active_joint_names(chain);
  for (const auto& row : number_rows(folder + "/franka_fr3_camera/fr3_camera.csv")) {
    if (row.size() < 23) continue;  // the header
    append_row(set, row, 7);
    Mat3 rotation;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) rotation(i, j) = row[7 + 4 * i + j];
    append_pose(set, Vec3(row[10], row[14], row[18]), Quat(rotation));
  }
  return set;
}

}  // namespace kinfer::study
