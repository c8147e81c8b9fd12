// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/merge_pose_sets.hpp"

#include <algorithm>
#include <limits>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

/// Appends the measurements of `more`, with their row indices offset.
template <class T>
void append_measurements(std::vector<T>& to, const std::vector<T>& more, int first_row) {
  for (T measurement : more) {
    measurement.row += first_row;
    if constexpr (std::is_same_v<T, PairDistance>) measurement.other += first_row;
    to.push_back(measurement);
  }
}

/// Index of `name` in `names`; appended if new.
int index_of(std::vector<std::string>& names, const std::string& name) {
  const auto place = std::find(names.begin(), names.end(), name);
  if (place != names.end()) return static_cast<int>(place - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

/// Concatenates per-row values; a set that has none is padded with `absent`.
template <class T>
std::vector<T> concatenate_padded(std::vector<T> first, const std::vector<T>& second, std::size_t rows,
                                  std::size_t more, T absent) {
  if (first.empty() && second.empty()) return {};
  first.resize(rows, absent);
  if (second.empty()) first.resize(rows + more, absent);
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

MatrixXd concatenate_padded(const MatrixXd& first, const MatrixXd& second, Eigen::Index dof, Eigen::Index rows,
                            Eigen::Index more) {
  if (first.size() == 0 && second.size() == 0) return {};
  MatrixXd both = MatrixXd::Constant(dof, rows + more, std::numeric_limits<double>::quiet_NaN());
  if (first.size() > 0) both.leftCols(rows) = first;
  if (second.size() > 0) both.rightCols(more) = second;
  return both;
}

/// Refers the measurements' fixtures to `names`, to which new ones are appended.
void rename_fixtures(PoseMeasurements& measured, const FixtureNames& old_names, FixtureNames& names) {
  for_each_list(measured, [&]<class M>(std::vector<M>& list) {
    if constexpr (RefersToFixture<M>)
      if (std::vector<std::string>* known = find_fixture_names(names, M::traits.fixture))
        for (M& measurement : list)
          measurement.*M::fixture_index =
              index_of(*known, (*find_fixture_names(old_names, M::traits.fixture))[measurement.*M::fixture_index]);
  });
}

std::vector<int> remap_indices(std::vector<int> indices, std::vector<std::string>& names,
                               const std::vector<std::string>& others) {
  for (int& index : indices)
    if (index >= 0) index = index_of(names, others[index]);
  return indices;
}

}  // namespace

PoseSet merge_pose_sets(const PoseSet& fitted, const PoseSet& held_out) {
  KINFER_EXPECT(fitted.joints.rows() == held_out.joints.rows());
  PoseSet more = held_out, all = fitted;
  const auto rows = static_cast<std::size_t>(fitted.rows()), count = static_cast<std::size_t>(more.rows());
  const auto first = static_cast<int>(rows);
  rename_fixtures(more, held_out, all);
  for_each_list(more, [&]<class M>(const std::vector<M>& list) { append_measurements(list_of<M>(all), list, first); });
  if (all.targets.empty()) all.targets = more.targets;

  const Eigen::Index dof = fitted.joints.rows();
  all.joints = concatenate_padded(fitted.joints, more.joints, dof, fitted.rows(), more.rows());
  all.commanded = concatenate_padded(fitted.commanded, more.commanded, dof, fitted.rows(), more.rows());
  all.approach = {};
  all.torques = concatenate_padded(fitted.torques, more.torques, dof, fitted.rows(), more.rows());
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  all.setup = concatenate_padded(all.setup, remap_indices(more.setup, all.setups, more.setups), rows, count, -1);
  all.sweep = concatenate_padded(all.sweep, remap_indices(more.sweep, all.sweeps, more.sweeps), rows, count, -1);
  all.tip = concatenate_padded(all.tip, remap_indices(more.tip, all.tips, more.tips), rows, count, -1);
  all.mounting = concatenate_padded(all.mounting, more.mounting, rows, count, -1);
  all.payload = concatenate_padded(all.payload, more.payload, rows, count, 0.0);
  all.temperature = concatenate_padded(all.temperature, more.temperature, rows, count, unknown);
  all.id = concatenate_padded(all.id, more.id, rows, count, std::string());
  all.line = concatenate_padded(all.line, more.line, rows, count, 0);
  all.time = {};  // of two clocks
  all.set.assign(rows, SplitLabel::train);
  all.set.resize(rows + count, SplitLabel::holdout);
  return all;
}

}  // namespace kinfer
