// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/model_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/calibrate/terms/approximate_masses.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::calibrate {
namespace {

bool is_revolute(const Joint& joint) {
  return rotates(joint.type);
}
bool is_actuated_revolute(const Joint& joint) {
  return is_revolute(joint) && joint.is_active;
}

template <class Keep>
void free_joint_parameters(ModelTerm& model_term, Field field, double prior_sd, Keep keep) {
  for (int j = 0; j < static_cast<int>(model_term.nominal.joints.size()); ++j)
    if (keep(model_term.nominal.joints[j]))
      model_term.parameters.push_back(parameter_at(model_term.nominal, JointNumber{j, field}, prior_sd));
}

void add_harmonic(ModelTerm& model_term, int joint, double order, double prior_sd) {
  std::vector<Harmonic>& harmonics = model_term.nominal.joints[joint].harmonics;
  const auto known =
      std::find_if(harmonics.begin(), harmonics.end(), [&](const Harmonic& h) { return h.order == order; });
  const auto term = static_cast<int>(known - harmonics.begin());
  if (known == harmonics.end()) harmonics.push_back({order});
  for (const Field field : {Field::sine, Field::cosine})
    model_term.parameters.push_back(parameter_at(model_term.nominal, JointNumber{joint, field, term}, prior_sd));
}

std::vector<double> finite(const std::vector<double>& values) {
  std::vector<double> list;
  for (const double value : values)
    if (std::isfinite(value)) list.push_back(value);
  return list;
}

/// 5-95 % range.
double spread(const std::vector<double>& values) {
  return values.size() < 2 ? 0.0 : quantile(values, 0.95) - quantile(values, 0.05);
}

ModelTerm gains(const Chain& nominal, const TermInputs& inputs) {
  ModelTerm model_term{.nominal = nominal};
  free_joint_parameters(model_term, Field::gain, inputs.tolerances.gain, is_actuated_revolute);
  return model_term;
}

/// Revolute joints coupled to the one or two actuated joints before them: transmissions of parallelograms and hollow
/// wrists.
ModelTerm coupling(const Chain& nominal, const TermInputs&) {
  ModelTerm model_term{.nominal = nominal};
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
          parameter_at(model_term.nominal, JointNumber{j, Field::coupling, k}, thresholds::coupling_prior));
  }
  return model_term;
}

ModelTerm gravity(const Chain& nominal, const TermInputs& inputs) {
  ModelTerm model_term{.nominal = nominal};
  const std::vector<double>& payload = inputs.rows.payload;
  const bool has_payload = std::any_of(payload.begin(), payload.end(), [](double kg) { return kg > 0.0; });
  if (nominal.masses.empty() && !has_payload) {
    model_term.nominal = with_approximate_masses(nominal);
    model_term.masses_approximate = true;
  }
  if (nominal.gravity.norm() == 0.0) model_term.missing = MissingData::gravity;
  free_joint_parameters(model_term, Field::compliance, inputs.tolerances.compliance, is_revolute);
  return model_term;
}

ModelTerm torques(const Chain& nominal, const TermInputs& inputs) {
  ModelTerm model_term{.nominal = nominal};
  free_joint_parameters(model_term, Field::torque_compliance, inputs.tolerances.compliance, is_actuated_revolute);
  if (inputs.rows.torques.size() == 0) model_term.missing = MissingData::torques;
  return model_term;
}

ModelTerm gear(const Chain& nominal, const TermInputs&) {
  ModelTerm model_term{.nominal = nominal};
  for (int j = 0; j < static_cast<int>(nominal.joints.size()); ++j)
    if (is_actuated_revolute(nominal.joints[j]))
      for (const double order : {1.0, 2.0}) add_harmonic(model_term, j, order, thresholds::harmonic_prior);
  return model_term;
}

ModelTerm spectrum(const Chain& nominal, const TermInputs& inputs) {
  ModelTerm model_term{.nominal = nominal};
  for (const SpectralLine& line : inputs.lines)
    add_harmonic(model_term, line.joint, line.order, thresholds::harmonic_prior);
  if (inputs.lines.empty()) model_term.missing = MissingData::spectral_line;
  return model_term;
}

ModelTerm backlash(const Chain& nominal, const TermInputs& inputs) {
  ModelTerm model_term{.nominal = nominal};
  if (inputs.rows.approach.size() == 0) model_term.missing = MissingData::approach_order;
  free_joint_parameters(model_term, Field::backlash, thresholds::backlash_prior,
                        [](const Joint& joint) { return joint.is_active && has_position(joint.type); });
  return model_term;
}

ModelTerm temperature(const Chain& nominal, const TermInputs& inputs) {
  ModelTerm model_term{.nominal = nominal};
  model_term.parameters.push_back(parameter_at(nominal, ExpansionNumber{}, thresholds::expansion_prior));
  const std::vector<double> measured = finite(inputs.rows.temperature);
  if (spread(measured) < thresholds::min_temperature_range)
    model_term.missing = inputs.rows.temperature.empty() ? MissingData::temperature : MissingData::temperature_range;
  else if (nominal.reference_temperature == 0.0)
    model_term.nominal.reference_temperature = median(measured);
  return model_term;
}

constexpr std::array<TermMaker, term_count - 1> makers{{{Term::gain, gains},
                                                        {Term::coupling, coupling},
                                                        {Term::gravity_compliance, gravity},
                                                        {Term::torque_compliance, torques},
                                                        {Term::gear_harmonics, gear},
                                                        {Term::spectral_harmonics, spectrum},
                                                        {Term::backlash, backlash},
                                                        {Term::thermal_expansion, temperature}}};

}  // namespace

std::span<const TermMaker> term_makers() {
  return makers;
}

ModelTerm make_model_term(Term term, const Chain& nominal, const TermInputs& inputs) {
  return std::ranges::find(makers, term, &TermMaker::term)->make(nominal, inputs);
}

}  // namespace kinfer::calibrate
