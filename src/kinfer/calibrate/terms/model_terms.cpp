// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/model_terms.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/terms/approximate_masses.hpp"
#include "kinfer/calibrate/terms/gear_harmonics.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

constexpr double coupling_prior = 1e-2;    // [rad/rad]: ratios are known better than the couplings' existence
constexpr double harmonic_prior = 0.2e-3;  // [rad]: errors of eccentric gears and encoder rings are smaller
constexpr double backlash_prior = 0.3e-3;  // [rad], or [m] for prismatic joints
constexpr double expansion_prior = 20e-6;  // [1/K]: between steel and aluminium

bool is_revolute(const Joint& joint) {
  return joint.type == JointType::revolute;
}
bool is_actuated_revolute(const Joint& joint) {
  return is_revolute(joint) && joint.is_active;
}

template <class Keep>
void free_joint_parameters(ModelTerm& model_term, Field field, double prior_sd, Keep keep) {
  for (int j = 0; j < static_cast<int>(model_term.nominal.joints.size()); ++j)
    if (keep(model_term.nominal.joints[j]))
      model_term.parameters.push_back(parameter_at(model_term.nominal, {Owner::joint, j, field}, prior_sd));
}

void add_harmonic(ModelTerm& model_term, int joint, double order, double prior_sd) {
  std::vector<Harmonic>& harmonics = model_term.nominal.joints[joint].harmonics;
  const auto known =
      std::find_if(harmonics.begin(), harmonics.end(), [&](const Harmonic& h) { return h.order == order; });
  const auto term = static_cast<int>(known - harmonics.begin());
  if (known == harmonics.end()) harmonics.push_back({order});
  for (const Field field : {Field::sine, Field::cosine})
    model_term.parameters.push_back(parameter_at(model_term.nominal, {Owner::joint, joint, field, term}, prior_sd));
}

double spread(const std::vector<double>& values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  return finite.size() < 2 ? 0.0 : quantile(finite, 0.95) - quantile(finite, 0.05);
}

ModelTerm gains(ModelTerm model_term, const CalibrationTask& task) {
  model_term.description = "a gain of each turning joint's encoder";
  free_joint_parameters(model_term, Field::gain, task.tolerances.gain, is_actuated_revolute);
  return model_term;
}

/// Revolute joints coupled to the one or two actuated joints before them: transmissions of parallelograms and hollow
/// wrists.
ModelTerm coupling(ModelTerm model_term) {
  model_term.description =
      "how far each turning joint follows the readings of the two before it (transmissions, parallelograms)";
  for (int j = 0; j < static_cast<int>(model_term.nominal.joints.size()); ++j) {
    Joint& joint = model_term.nominal.joints[j];
    if (!is_revolute(joint)) continue;
    int before = joint.parent;
    for (int steps = 0; steps < 2 && before >= 0; ++steps, before = model_term.nominal.joints[before].parent) {
      const auto known = [&](const Coupling& c) { return c.joint == before; };
      if (is_actuated_revolute(joint) && is_actuated_revolute(model_term.nominal.joints[before]) &&
          std::none_of(joint.couplings.begin(), joint.couplings.end(), known))
        joint.couplings.push_back({before, 0.0});
    }
    for (int k = 0; k < static_cast<int>(joint.couplings.size()); ++k)
      model_term.parameters.push_back(
          parameter_at(model_term.nominal, {Owner::joint, j, Field::coupling, k}, coupling_prior));
  }
  return model_term;
}

ModelTerm gravity(ModelTerm model_term, const CalibrationTask& task, const PoseSet& rows) {
  model_term.description = "compliance of each turning joint under gravity";
  const bool payload = std::any_of(rows.payload.begin(), rows.payload.end(), [](double kg) { return kg > 0.0; });
  if (model_term.nominal.masses.empty() && !payload) {
    model_term.description =
        "compliance of each turning joint under gravity, with masses guessed from the lengths of the links";
    model_term.nominal = with_approximate_masses(model_term.nominal);
  }
  if (model_term.nominal.gravity.norm() == 0.0) model_term.skipped = "gravity is zero in the robot file";
  free_joint_parameters(model_term, Field::compliance, task.tolerances.compliance, is_revolute);
  return model_term;
}

ModelTerm torques(ModelTerm model_term, const CalibrationTask& task, const PoseSet& rows) {
  model_term.description = "compliance of each joint by its measured torque";
  free_joint_parameters(model_term, Field::torque_compliance, task.tolerances.compliance, is_actuated_revolute);
  if (rows.torques.size() == 0) model_term.skipped = "no joint torques were measured (columns tau1, tau2, …)";
  return model_term;
}

ModelTerm gear(ModelTerm model_term) {
  model_term.description = "what comes back once and twice a turn of each joint (eccentric gears and encoders)";
  for (int j = 0; j < static_cast<int>(model_term.nominal.joints.size()); ++j)
    if (is_actuated_revolute(model_term.nominal.joints[j]))
      for (const double order : {1.0, 2.0}) add_harmonic(model_term, j, order, harmonic_prior);
  return model_term;
}

ModelTerm spectrum(ModelTerm model_term, const PoseSet& rows, const Estimate& fitted) {
  const std::vector<SpectralLine> lines = find_gear_harmonics(fitted, rows);
  for (const SpectralLine& line : lines) add_harmonic(model_term, line.joint, line.order, harmonic_prior);
  model_term.description = "what else the spectrum of the residuals shows";
  if (lines.empty()) model_term.skipped = "the spectrum of the residuals shows no further line";
  return model_term;
}

ModelTerm backlash(ModelTerm model_term, const PoseSet& rows) {
  model_term.description = "a shift by the side from which each joint was approached (the order of the rows)";
  if (rows.approach.size() == 0) model_term.skipped = "the order in which the poses were driven to is not known";
  free_joint_parameters(model_term, Field::backlash, backlash_prior,
                        [](const Joint& joint) { return joint.is_active && joint.type != JointType::fixed; });
  return model_term;
}

ModelTerm temperature(ModelTerm model_term, const PoseSet& rows) {
  model_term.description = "thermal growth of all lengths";
  constexpr double least_spread = 1.0;  // [K]
  model_term.parameters.push_back(
      parameter_at(model_term.nominal, {Owner::robot, -1, Field::expansion}, expansion_prior));
  if (spread(rows.temperature) < least_spread)
    model_term.skipped =
        rows.temperature.empty() ? "no temperature was measured" : "the temperature hardly changed (less than 1 K)";
  else if (model_term.nominal.reference_temperature == 0.0) {
    std::vector<double> finite;
    for (const double t : rows.temperature)
      if (std::isfinite(t)) finite.push_back(t);
    model_term.nominal.reference_temperature = median(finite);
  }
  return model_term;
}

}  // namespace

std::vector<std::string> model_term_names() {
  return {"gains", "coupling", "gravity", "torques", "gear", "spectrum", "backlash", "temperature"};
}

ModelTerm make_model_term(const Chain& nominal, const std::string& name, const CalibrationTask& task,
                          const PoseSet& rows, const Estimate& fitted) {
  ModelTerm model_term{.name = name, .nominal = nominal};
  if (name == "gains") return gains(model_term, task);
  if (name == "coupling") return coupling(model_term);
  if (name == "gravity") return gravity(model_term, task, rows);
  if (name == "torques") return torques(model_term, task, rows);
  if (name == "gear") return gear(model_term);
  if (name == "spectrum") return spectrum(model_term, rows, fitted);
  if (name == "backlash") return backlash(model_term, rows);
  return temperature(model_term, rows);
}

}  // namespace kinfer::calibrate
