// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/conventions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

using std::string_literals::operator""s;

enum class Correction { apply, report_only };

struct Hypothesis {
  FindingKind kind;
  FactValues values;
  Correction correction = Correction::apply;
  std::function<void(Chain&, PoseSet&)> apply;
};

bool is_revolute(const Chain& chain, int joint) {
  return rotates(chain.joints[joint].type);
}

/// Scales the positions of joint k, measured and commanded.
void scale_joint_position(PoseSet& data, Eigen::Index k, double factor) {
  data.joints.row(k) *= factor;
  if (data.commanded.size() > 0) data.commanded.row(k) *= factor;
}

void scale_points(PoseSet& data, double factor) {
  for (PointMeasurement& point : data.points) {
    point.position *= factor;
    if (point.sd) *point.sd *= factor;
  }
  for (OrientationMeasurement& measured : data.orientations)
    if (measured.covariance_with_point) *measured.covariance_with_point *= factor;
}

void add_offset(Joint& joint, double angle) {
  if (auto* dh = std::get_if<DhLink>(&joint.link)) dh->theta += angle;
  if (auto* mdh = std::get_if<MdhLink>(&joint.link)) mdh->theta += angle;
  if (auto* urdf = std::get_if<UrdfLink>(&joint.link))
    urdf->origin = Frame::from_pose({urdf->origin.pose().rotation * exp_so3(angle * urdf->axis), urdf->origin.xyz});
}

void add_unit_hypotheses(const Chain& chain, std::vector<Hypothesis>& list) {
  const std::vector<int> moving = active_joints(chain);
  const auto all = [&](JointType type, double factor) {
    return [&chain, moving, type, factor](Chain&, PoseSet& data) {
      for (std::size_t k = 0; k < moving.size(); ++k)
        if (chain.joints[moving[k]].type == type) scale_joint_position(data, static_cast<Eigen::Index>(k), factor);
    };
  };
  list.push_back({FindingKind::degrees_for_radians,
                  {{"unit", "deg"s}, {"read_as", "rad"s}},
                  Correction::apply,
                  all(JointType::revolute, degree)});
  list.push_back({FindingKind::radians_for_degrees,
                  {{"unit", "rad"s}, {"read_as", "deg"s}},
                  Correction::apply,
                  all(JointType::revolute, 1.0 / degree)});
  const auto positions = [&](const std::string& unit, const std::string& read_as, double factor) {
    list.push_back({FindingKind::length_unit,
                    {{"unit", unit}, {"read_as", read_as}},
                    Correction::apply,
                    [factor](Chain&, PoseSet& data) { scale_points(data, factor); }});
  };
  positions("mm", "m", 1e-3);
  positions("m", "mm", 1e3);
  positions("in", "mm", 25.4);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const std::string& name = chain.joints[moving[k]].name;
    const auto add = [&](FindingKind kind, const std::string& unit, const std::string& read_as, double factor) {
      list.push_back({kind,
                      {{"joint", name}, {"column", static_cast<int>(k) + 1}, {"unit", unit}, {"read_as", read_as}},
                      Correction::apply,
                      [row, factor](Chain&, PoseSet& data) { scale_joint_position(data, row, factor); }});
    };
    if (is_revolute(chain, moving[k])) {
      add(FindingKind::degrees_for_radians, "deg", "rad", degree);
      add(FindingKind::radians_for_degrees, "rad", "deg", 1.0 / degree);
    } else {
      add(FindingKind::length_unit, "mm", "m", 1e-3);
      add(FindingKind::length_unit, "m", "mm", 1e3);
    }
  }
}

void add_joint_hypotheses(const Chain& chain, std::vector<Hypothesis>& list) {
  const std::vector<int> moving = active_joints(chain);
  for (const int j : moving) {
    const std::string& name = chain.joints[j].name;
    list.push_back({FindingKind::wrong_sign,
                    {{"joint", name}, {"gain", -chain.joints[j].gain}},
                    Correction::apply,
                    [j](Chain& c, PoseSet&) { c.joints[j].gain = -c.joints[j].gain; }});
  }
  for (const int j : moving) {
    const std::string& name = chain.joints[j].name;
    if (!is_revolute(chain, j)) continue;
    for (const int offset : {90, -90, 180})
      list.push_back({FindingKind::joint_offset,
                      {{"joint", name}, {"offset_rad", offset * degree}},
                      Correction::apply,
                      [j, offset](Chain& c, PoseSet&) { add_offset(c.joints[j], offset * degree); }});
  }
}

/// Swapped columns, and joints whose position counts from the world instead of the previous link.
void add_relation_hypotheses(const Chain& chain, std::vector<Hypothesis>& list) {
  const std::vector<int> moving = active_joints(chain);
  for (std::size_t k = 0; k < moving.size(); ++k)
    for (std::size_t m = 0; m < k; ++m) {
      const int j = moving[k], i = moving[m];
      if (chain.joints[i].type != chain.joints[j].type) continue;
      const auto a = static_cast<Eigen::Index>(m), b = static_cast<Eigen::Index>(k);
      list.push_back({FindingKind::columns_swapped,
                      {{"joints", std::vector{chain.joints[i].name, chain.joints[j].name}},
                       {"columns", std::vector{static_cast<int>(m) + 1, static_cast<int>(k) + 1}}},
                      Correction::apply,
                      [a, b](Chain&, PoseSet& data) {
                        data.joints.row(a).swap(data.joints.row(b));
                        if (data.commanded.size() > 0) data.commanded.row(a).swap(data.commanded.row(b));
                      }});
      if (m + 1 != k || !is_revolute(chain, j)) continue;
      for (const int factor : {1, -1})
        list.push_back({FindingKind::joint_coupled,
                        {{"joint", chain.joints[j].name}, {"follows", chain.joints[i].name}, {"factor", factor}},
                        Correction::apply,
                        [j, i, factor](Chain& c, PoseSet&) {
                          c.joints[j].couplings.push_back({i, static_cast<double>(factor)});
                        }});
    }
}

std::vector<Hypothesis> hypotheses(const Chain& chain) {
  std::vector<Hypothesis> list;
  add_unit_hypotheses(chain, list);
  add_joint_hypotheses(chain, list);
  add_relation_hypotheses(chain, list);
  list.push_back({FindingKind::mirrored, {}, Correction::report_only, [](Chain&, PoseSet& data) {
                    for (PointMeasurement& point : data.points) point.position.x() *= -1.0;
                  }});
  return list;
}

/// A set of hypotheses applied together, and the error that remains.
struct Explanation {
  std::vector<std::size_t> indices;  // ascending indices into the list of hypotheses
  Chain chain;
  PoseSet data;
  double median_error = 0.0;
  /// [1] the same over the spread of the points: a unit that makes all points smaller makes their errors smaller, too,
  /// and explains nothing by that.
  double relative_error = 0.0;
  std::vector<std::vector<std::size_t>> others{};  // sets that explain the points equally well
};

class HypothesisSearch {
 public:
  explicit HypothesisSearch(const CalibrationTask& task)
      : list_(hypotheses(task.nominal)),
        max_plausible_error_(max_plausible_error(task)),
        unmodified_{{}, task.nominal, thin_pose_set(task.data, thresholds::hypothesis_rows), 0.0} {}

  /// The smallest set of hypotheses that leaves a plausible error; nullopt if none is needed or found.
  std::optional<Explanation> run() {
    if (unmodified_.data.rows() < thresholds::min_hypothesis_rows || !evaluate(unmodified_) ||
        unmodified_.median_error <= max_plausible_error_)
      return std::nullopt;
    std::vector<Explanation> beam{unmodified_};
    for (int depth = 0; depth < thresholds::max_simultaneous_faults; ++depth) {
      std::vector<Explanation> next;
      for (const Explanation& base : beam) expand(base, next);
      std::stable_sort(next.begin(), next.end(),
                       [](const Explanation& a, const Explanation& b) { return a.relative_error < b.relative_error; });
      if (next.empty()) return std::nullopt;
      if (explains(next.front())) return first_equivalent(next);
      if (next.size() > thresholds::beam_width) next.erase(next.begin() + thresholds::beam_width, next.end());
      beam = std::move(next);
    }
    return std::nullopt;
  }

  const Hypothesis& operator[](std::size_t i) const { return list_[i]; }

 private:
  static bool evaluate(Explanation& e) {
    const auto fit = fit_frames_quickly(e.chain, e.data);
    if (!fit) return false;
    e.median_error = fit->median_error;
    e.relative_error = e.median_error / rms_spread(point_positions(e.data));
    return std::isfinite(e.relative_error);
  }

  /// Some faults are equivalent up to base and tool, such as a half turn of a wrist joint and the sign of the next one.
  /// Of those that explain the points equally well: the first in the list, with the others as alternatives.
  static Explanation first_equivalent(const std::vector<Explanation>& sorted) {
    std::vector<const Explanation*> equal;
    for (const Explanation& e : sorted)
      if (e.relative_error <= thresholds::equivalent_ratio * sorted.front().relative_error) equal.push_back(&e);
    std::sort(equal.begin(), equal.end(), [](const auto* a, const auto* b) { return a->indices < b->indices; });
    Explanation first = *equal.front();
    for (std::size_t i = 1; i < equal.size(); ++i) first.others.push_back(equal[i]->indices);
    return first;
  }

  void expand(const Explanation& base, std::vector<Explanation>& next) const {
    const std::size_t first = base.indices.empty() ? 0 : base.indices.back() + 1;
    for (std::size_t i = first; i < list_.size(); ++i) {
      Explanation e = base;
      e.indices.push_back(i);
      list_[i].apply(e.chain, e.data);
      if (evaluate(e)) next.push_back(std::move(e));
    }
  }

  /// Plausible by the tolerances, or so much better than without that a poor nominal model must cause the rest.
  bool explains(const Explanation& e) const {
    const double ratio = e.median_error <= max_plausible_error_ ? thresholds::plausible_improvement
                                                                : thresholds::implausible_improvement;
    return e.relative_error < ratio * unmodified_.relative_error;
  }

  std::vector<Hypothesis> list_;
  double max_plausible_error_;
  Explanation unmodified_;
};

/// A robot in another unit leaves errors as large as the points' spread.
bool has_the_size_of_its_points(const CalibrationTask& task) {
  if (task.data.points.empty()) return false;
  const PoseSet rows = thin_pose_set(task.data, thresholds::hypothesis_rows);
  const auto fit = fit_frames_quickly(task.nominal, rows);
  return fit && fit->median_error < thresholds::fitting_part_of_spread * rms_spread(point_positions(rows));
}

/// A reach of a few millimetres or a hundred metres: the robot file, not the measurement, has the wrong unit, unless
/// the points are as far apart.
void check_robot_size(DiagnosisState& state) {
  const Chain& chain = state.task.nominal;
  double reach = chain.tool.xyz.norm();
  for (const JointPlacement& joint : joint_placements(chain, VectorXd::Zero(dof(chain))))
    reach = std::max(reach, (joint.frame.position - chain.base.xyz).norm());
  if (reach > thresholds::smallest_reach && reach < thresholds::largest_reach) return;
  const Severity severity = has_the_size_of_its_points(state.task) ? Severity::warning : Severity::fault;
  add_finding(state, {.kind = FindingKind::robot_length_unit, .severity = severity, .values = {{"reach_m", reach}}});
}

}  // namespace

void check_conventions(DiagnosisState& state) {
  check_robot_size(state);
  if (state.task.data.points.empty()) return;
  HypothesisSearch search(state.task);
  const auto found = search.run();
  if (!found) return;
  for (const std::size_t i : found->indices) {
    const Hypothesis& h = search[i];
    const bool apply = h.correction == Correction::apply;
    if (apply) h.apply(state.task.nominal, state.task.data);
    Finding finding{.kind = h.kind, .severity = Severity::fault, .values = h.values, .applied = apply};
    for (const auto& other : found->others)
      if (found->indices.size() == 1)
        finding.equivalents.push_back({.kind = search[other.front()].kind, .values = search[other.front()].values});
    add_finding(state, std::move(finding));
  }
}

}  // namespace kinfer::calibrate
