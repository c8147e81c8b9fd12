// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/joint_relaxation.hpp"

#include <algorithm>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/geometry/mean_revolute.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {
namespace {

RefinementSetup relaxed_setup(const RefinementFit& fitted, const std::vector<std::size_t>& bodies) {
  RefinementSetup setup = fitted.setup;
  setup.start = fitted.fit.unknowns;
  for (const std::size_t body : bodies)
    relax_to_spherical(setup.start, layout_of(setup.problem, setup.start.bodies), body);
  anchor(setup);
  return setup;
}

/// Decrease of the log residual when a revolute joint is relaxed to a spherical one, the geometry held fixed.
double relaxation_gain(const RefinementTask& task, const RefinementFit& fitted, std::size_t body) {
  RefinementFit spherical{relaxed_setup(fitted, {body}), {}};
  spherical.fit = fit_motion_only(task, spherical.setup);
  return log_residual(fitted) - log_residual(spherical);
}

/// The bodies of the revolute joints that may be relaxed. A universal joint consists of two revolute bodies, neither of
/// which is a joint. A joint whose axis was measured stays revolute: a spherical one has no axis that a tape ends at.
std::vector<std::size_t> relaxable_bodies(const RefinementTask& task, const RefinementFit& fitted) {
  std::vector<std::size_t> bodies;
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    const std::size_t body = fitted.setup.first_body[i];
    if (task.starts[i].type == EstimatedJointType::revolute && !is_measured_axis(task.facts, body))
      bodies.push_back(body);
  }
  std::ranges::sort(bodies);
  return bodies;
}

}  // namespace

std::vector<std::size_t> select_joints_to_relax(const std::vector<std::size_t>& revolute_joints,
                                                const std::vector<double>& gains) {
  std::vector<std::size_t> to_relax;
  for (std::size_t i = 0; i < revolute_joints.size(); ++i) {
    std::vector<double> others = gains;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (gains[i] > min_relaxation_gain && (others.empty() || gains[i] > min_gain_ratio_to_others * median(others)))
      to_relax.push_back(revolute_joints[i]);
  }
  return to_relax;
}

RefinementFit relax_joints(const RefinementTask& task, RefinementFit fitted, const Observer& observer) {
  const std::vector<std::size_t> revolute_joints = relaxable_bodies(task, fitted);
  std::vector<double> gains;
  for (const std::size_t body : revolute_joints) {
    report_progress(observer, "loose joints",
                    static_cast<double>(gains.size()) / static_cast<double>(revolute_joints.size()));
    gains.push_back(relaxation_gain(task, fitted, body));
  }
  const auto to_relax = select_joints_to_relax(revolute_joints, gains);
  if (to_relax.empty()) return fitted;
  return fit_from(task, relaxed_setup(fitted, to_relax));
}

}  // namespace kinfer::identify
