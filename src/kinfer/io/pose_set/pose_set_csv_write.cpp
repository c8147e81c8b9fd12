// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/measurement_columns.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"

namespace kinfer {
namespace {

void write_joint_values(PoseSheet& sheet, const Chain& chain, const MatrixXd& values, const char* prefix,
                        const char* suffix) {
  const std::vector<int> joints = active_joints(chain);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const bool is_prismatic = translates(chain.joints[joints[i]].type);
    const std::size_t column = sheet.column(
        fmt::format("{}{}{}{}", prefix, i + 1, suffix, is_prismatic ? sheet.in_lengths() : sheet.in_angles()));
    for (int row = 0; row < values.cols(); ++row)
      sheet.set(column, row, values(i, row), is_prismatic ? sheet.length() : sheet.angle());
  }
}

void write_torques(PoseSheet& sheet, const MatrixXd& torques) {
  for (Eigen::Index i = 0; i < torques.rows(); ++i) {
    const std::size_t column = sheet.column(fmt::format("tau{}", i + 1));
    for (int row = 0; row < torques.cols(); ++row) sheet.set(column, row, torques(i, row));
  }
}

void write_numbers(PoseSheet& sheet, const std::vector<double>& values, const char* header) {
  if (values.empty()) return;
  const std::size_t column = sheet.column(header);
  for (std::size_t row = 0; row < values.size(); ++row) sheet.set(column, static_cast<int>(row), values[row]);
}

void write_names(PoseSheet& sheet, const std::vector<int>& index, const std::vector<std::string>& names,
                 const char* header) {
  if (names.empty()) return;
  const std::size_t column = sheet.column(header);
  for (std::size_t row = 0; row < index.size(); ++row)
    if (index[row] >= 0) sheet.set(column, static_cast<int>(row), names[index[row]]);
}

void write_origin(PoseSheet& sheet, const RowOrigin& origin) {
  if (!origin.id.empty()) {
    const std::size_t id = sheet.column("id");
    for (std::size_t row = 0; row < origin.id.size(); ++row) sheet.set(id, static_cast<int>(row), origin.id[row]);
  }
  if (origin.set.empty()) return;
  const std::size_t label = sheet.column("set");
  for (std::size_t row = 0; row < origin.set.size(); ++row)
    if (origin.set[row] != SplitLabel::none)
      sheet.set(label, static_cast<int>(row), std::string(origin.set[row] == SplitLabel::train ? "train" : "holdout"));
}

}  // namespace

std::string format_pose_set_csv(const PoseSet& set, const Chain& chain, FileUnits units) {
  PoseSheet sheet(static_cast<std::size_t>(set.rows()), units);
  write_joint_values(sheet, chain, set.joints, "q", "");
  write_joint_values(sheet, chain, set.commanded, "q", "_cmd");
  write_torques(sheet, set.torques);
  for_each_list(set, [&]<class M>(const std::vector<M>&) { measurement_columns<M>().write(sheet, set); });
  write_numbers(sheet, set.time, "t[s]");
  write_numbers(sheet, set.payload, "payload[kg]");
  write_numbers(sheet, set.temperature, "temperature[C]");
  write_names(sheet, set.setup, set.setups, "setup");
  write_names(sheet, set.tip, set.tips, "tip");
  write_names(sheet, set.sweep, set.sweeps, "sweep");
  write_origin(sheet, set);
  return sheet.csv();
}

}  // namespace kinfer
