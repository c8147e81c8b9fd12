#include "kinfer/calibrate/excitation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

void find_still_joints(const std::vector<JointExcitation>& joints, std::vector<std::string>& found) {
  for (const JointExcitation& j : joints) {
    const double needed =
        j.turns ? 5.0 * degree : 5e-3;  // sd; below, its parameters are hardly told apart from others'
    if (j.sd < needed)
      found.push_back(
          fmt::format("{} hardly moves; its parameters cannot be determined: measure poses where it does", j.name));
  }
}

void find_degrees(const std::vector<JointExcitation>& joints, std::vector<std::string>& found) {
  constexpr double two_turns = 4.0 * std::numbers::pi;
  for (const JointExcitation& j : joints)
    if (j.turns && std::max(std::abs(j.lowest), std::abs(j.highest)) > two_turns)
      found.push_back(fmt::format("{} reads up to {:.0f} rad: are these degrees? Then the header should say [deg]",
                                  j.name, std::max(std::abs(j.lowest), std::abs(j.highest))));
}

void find_repeated_rows(const PoseSet& set, std::vector<std::string>& found) {
  std::map<std::vector<double>, std::vector<int>> places;
  for (Eigen::Index row = 0; row < set.rows(); ++row)
    places[{set.joints.col(row).begin(), set.joints.col(row).end()}].push_back(static_cast<int>(row));
  for (const auto& [q, rows] : places)
    if (rows.size() > 1)
      found.push_back(fmt::format("rows {} and {} have the same joint readings{}", rows[0], rows[1],
                                  rows.size() > 2 ? fmt::format(" (and {} more)", rows.size() - 2) : ""));
}

void find_unsettled_readings(const PoseSet& set, std::vector<std::string>& found) {
  if (set.commanded.size() == 0) return;
  std::vector<double> difference;
  for (Eigen::Index row = 0; row < set.rows(); ++row) {
    const double d = (set.commanded.col(row) - set.joints.col(row)).cwiseAbs().maxCoeff();
    if (std::isfinite(d)) difference.push_back(d);
  }
  constexpr double settled = 0.05 * degree;
  if (difference.empty() || median(difference) < settled) return;
  found.push_back(
      fmt::format("commanded and read-back joints differ by {:.3f} deg typically: was the arm still moving?",
                  median(difference) / degree));
}

}  // namespace

std::vector<JointExcitation> joint_excitation(const Chain& chain, const PoseSet& set) {
  std::vector<JointExcitation> joints;
  const std::vector<int> moving = joints_with_reading(chain);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const auto values = set.joints.row(static_cast<Eigen::Index>(k));
    const std::vector<double> list(values.begin(), values.end());
    joints.push_back({set.joint_names[k], chain.joints[moving[k]].type == JointType::revolute, values.minCoeff(),
                      values.maxCoeff(), standard_deviation(list)});
  }
  return joints;
}

std::vector<std::string> findings(const PoseSet& set, const std::vector<JointExcitation>& joints) {
  std::vector<std::string> found;
  find_still_joints(joints, found);
  find_degrees(joints, found);
  find_repeated_rows(set, found);
  find_unsettled_readings(set, found);
  return found;
}

}  // namespace kinfer
