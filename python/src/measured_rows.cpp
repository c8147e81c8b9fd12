// SPDX-License-Identifier: Apache-2.0
#include "measured_rows.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::python {
namespace {

/// Distinct names in the order of their first appearance, and the index of each row.
void read_names(const py::object& values, const std::string& name, Eigen::Index rows, std::vector<std::string>& names,
                std::vector<int>& index) {
  for (const py::handle value : values) {
    const std::string text = py::str(value);
    const auto found = std::ranges::find(names, text);
    index.push_back(static_cast<int>(found - names.begin()));
    if (found == names.end()) names.push_back(text);
  }
  if (static_cast<Eigen::Index>(index.size()) != rows)
    throw InputError(fmt::format("{}: expected {} names, one per row, found {}", name, rows, index.size()));
}

/// The standard deviation of every row; one number is the instrument's and not that of the rows.
std::vector<std::optional<Vec3>> row_deviations(const py::object& sd, Eigen::Index rows) {
  std::vector<std::optional<Vec3>> list(rows);
  if (sd.is_none()) return list;
  const Numbers values = numbers(sd, "sd");
  if (values.ndim() == 0) return list;
  const bool same_in_all = values.ndim() == 1;
  const Numbers rows_of = same_in_all ? values : table(sd, "sd", 3, rows);
  if (same_in_all && values.shape(0) != rows)
    throw InputError(fmt::format("sd: expected one number, ({},) or ({}, 3)", rows, rows));
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double* row = rows_of.data() + (same_in_all ? i : 3 * i);
    list[i] = same_in_all ? Vec3::Constant(*row) : Vec3(row[0], row[1], row[2]);
    if (!(list[i]->minCoeff() > 0.0) || !list[i]->allFinite())
      throw InputError(fmt::format("sd: row {} (from 0) is not positive", i));
  }
  return list;
}

void add_positions(const MeasuredArguments& given, PoseSet& set) {
  const Numbers xyz = table(given.positions, "positions", 3, set.rows());
  const auto sd = row_deviations(given.sd, set.rows());
  for (Eigen::Index i = 0; i < set.rows(); ++i) {
    const Vec3 position(xyz.data() + 3 * i);
    if (position.array().isNaN().all()) continue;
    if (!position.allFinite())
      throw InputError(fmt::format("positions: row {} (from 0) has a number that is not finite", i));
    set.points.push_back({.row = static_cast<int>(i), .position = position, .sd = sd[i]});
  }
}

void add_poses(const MeasuredArguments& given, PoseSet& set) {
  const auto list = poses(given.poses, "poses", set.rows());
  const auto sd = row_deviations(given.sd, set.rows());
  for (int i = 0; i < static_cast<int>(list.size()); ++i) {
    if (!list[i]) continue;
    set.points.push_back({.row = i, .position = list[i]->position, .sd = sd[i]});
    set.orientations.push_back({.row = i, .orientation = Quat(list[i]->rotation)});
  }
}

void add_distances(const MeasuredArguments& given, const Chain& chain, PoseSet& set) {
  const auto distances = list_of_numbers(given.distances, "distances", set.rows());
  std::vector<double> anchors(distances.size(), 0.0);
  if (!given.anchors.is_none()) anchors = list_of_numbers(given.anchors, "anchors", set.rows());
  const std::size_t known = chain.fixtures.anchors.size();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (std::isnan(distances[i])) continue;
    if (!(distances[i] >= 0.0) || !std::isfinite(distances[i]))
      throw InputError(fmt::format("distances: row {} (from 0) is negative or not finite", i));
    if (!(anchors[i] >= 0.0 && anchors[i] < static_cast<double>(known) && anchors[i] == std::floor(anchors[i])))
      throw InputError(fmt::format("anchors: row {} (from 0) is {}; the robot file has {} anchors, counted from 0", i,
                                   anchors[i], known));
    set.distances.push_back({static_cast<int>(i), static_cast<int>(anchors[i]), distances[i]});
  }
}

}  // namespace

PoseSet measured_rows(const py::handle& joints, const Chain& chain, const MeasuredArguments& given) {
  PoseSet set;
  const Numbers q = joint_positions(joints, chain);
  set.joint_names = active_joint_names(chain);
  set.joints = as_columns(q);
  for (int i = 0; i < static_cast<int>(set.rows()); ++i) set.line.push_back(i + 1);
  if (!given.positions.is_none() && !given.poses.is_none())
    throw InputError("positions and poses: expected one of them; poses hold the positions");
  if (!given.positions.is_none()) add_positions(given, set);
  if (!given.poses.is_none()) add_poses(given, set);
  if (!given.distances.is_none()) add_distances(given, chain, set);
  if (!given.sockets.is_none()) {
    std::vector<int> socket;
    read_names(given.sockets, "sockets", set.rows(), set.sockets, socket);
    for (std::size_t i = 0; i < socket.size(); ++i) set.contacts.push_back({static_cast<int>(i), socket[i]});
  }
  if (!given.setup.is_none()) read_names(given.setup, "setup", set.rows(), set.setups, set.setup);
  if (!has_measurements(set))
    throw InputError("nothing is measured: expected positions, poses, distances or sockets beside the joints");
  return set;
}

std::optional<Instrument> instrument_of(const MeasuredArguments& given, const RobotModel& robot) {
  std::optional<Instrument> instrument = robot.instrument;
  const bool single = !given.sd.is_none() && numbers(given.sd, "sd").ndim() == 0;
  if (!single) return instrument;
  if (!given.poses.is_none() && given.sd_angle.is_none())
    throw InputError("sd: with poses expected sd_angle too [rad]");
  instrument.emplace();
  instrument->sigma = numbers(given.sd, "sd").data()[0];
  if (!given.sd_angle.is_none()) instrument->sigma_angle = numbers(given.sd_angle, "sd_angle").data()[0];
  if (!(instrument->sigma >= 0.0) || !(instrument->sigma_angle >= 0.0))
    throw InputError("sd: expected a number from 0");
  return instrument;
}

}  // namespace kinfer::python
