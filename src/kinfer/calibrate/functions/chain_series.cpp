// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/chain_series.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/functions/harmonic_sum.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::calibrate {

int series_order(const Joint& joint) {
  std::size_t count = 0;
  while (count < joint.harmonics.size() && joint.harmonics[count].order == static_cast<double>(count)) ++count;
  for (auto r = resolutions.rbegin(); r != resolutions.rend(); ++r)
    if (static_cast<int>(count) > r->order) return r->order;
  return 0;
}

bool has_series(const Chain& chain) {
  return std::ranges::any_of(chain.joints, [](const Joint& joint) { return series_order(joint) > 0; });
}

bool is_in_series(const Joint& joint, double order) {
  return order <= series_order(joint) && order == std::round(order) && series_order(joint) > 0;
}

Chain without_series(Chain chain) {
  for (Joint& joint : chain.joints)
    if (const int order = series_order(joint); order > 0)
      for (int k = 0; k <= order; ++k) joint.harmonics[static_cast<std::size_t>(k)] = {static_cast<double>(k)};
  return chain;
}

Chain with_series_of(Chain chain, const Chain& other) {
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    std::vector<Harmonic>& own = chain.joints[j].harmonics;
    const std::vector<Harmonic>& theirs = other.joints[j].harmonics;
    const int before = series_order(chain.joints[j]), after = series_order(other.joints[j]);
    if (before > 0) own.erase(own.begin(), own.begin() + before + 1);
    if (after > 0) own.insert(own.begin(), theirs.begin(), theirs.begin() + after + 1);
  }
  return chain;
}

bool is_harmonic_field(Field field) {
  return field == Field::sine || field == Field::cosine;
}

DetachedSeries detach(const Chain& chain, const ParameterSet& set) {
  DetachedSeries apart{chain, set, {}};
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    const int order = series_order(chain.joints[j]);
    if (order == 0) continue;
    const Resolution resolution{knots_for(order), order};
    apart.series.push_back(
        {static_cast<int>(j), resolution, coefficients_of(chain.joints[j].harmonics, resolution.knots)});
    std::vector<Harmonic>& harmonics = apart.plain.joints[j].harmonics;
    harmonics.erase(harmonics.begin(), harmonics.begin() + order + 1);
    for (Parameter& p : apart.set.parameters)
      if (auto* at = std::get_if<JointNumber>(&p.at);
          at && at->joint == static_cast<int>(j) && is_harmonic_field(at->field))
        at->term -= order + 1;
  }
  return apart;
}

Chain attach(Chain plain, const std::vector<JointSeries>& series) {
  for (const JointSeries& s : series) {
    const std::vector<Harmonic> list = harmonics_of(s.coefficients, s.resolution.order);
    std::vector<Harmonic>& harmonics = plain.joints[s.joint].harmonics;
    harmonics.insert(harmonics.begin(), list.begin(), list.end());
  }
  return plain;
}

Chain with_series_moved(const Chain& chain, const VectorXd& step) {
  DetachedSeries apart = detach(chain, {});
  Eigen::Index begin = 0;
  for (JointSeries& series : apart.series) {
    const Eigen::Index knots = series.coefficients.size();
    KINFER_EXPECT(begin + knots <= step.size(), "{} steps, series from {} on have {} knots", step.size(), begin, knots);
    series.coefficients += step.segment(begin, knots);
    begin += knots;
  }
  return attach(apart.plain, apart.series);
}

PoseSet with_moved_joints(PoseSet rows, const Chain& plain, const std::vector<JointSeries>& series) {
  const std::vector<int> q_index = active_joint_indices(plain);
  for (const JointSeries& s : series) {
    const HarmonicSum sum(harmonics_of(s.coefficients, s.resolution.order));
    for (double& q : rows.joints.row(q_index[s.joint])) q += sum.at(q);
  }
  return rows;
}

}  // namespace kinfer::calibrate
