#include "kinfer/calibrate/rungs.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/gear_spectrum.hpp"
#include "kinfer/calibrate/guessed_masses.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double coupling_prior = 1e-2;  // of a turn: a transmission's ratio is known better, its existence may not be
constexpr double harmonic_prior = 0.2e-3;  // [rad]: eccentric gears and encoder rings are off by less
constexpr double backlash_prior = 0.3e-3;  // [rad] or, for slides, [m]
constexpr double expansion_prior = 20e-6;  // [1/K]: between steel and aluminium

bool is_revolute(const Joint& joint) {
  return joint.type == JointType::revolute;
}
bool turns_by_reading(const Joint& joint) {
  return is_revolute(joint) && joint.has_reading;
}

template <class Keep>
void free_joint_numbers(Rung& rung, Field field, double prior_sd, Keep keep) {
  for (int j = 0; j < static_cast<int>(rung.nominal.joints.size()); ++j)
    if (keep(rung.nominal.joints[j]))
      rung.further.push_back(parameter_at(rung.nominal, {Owner::joint, j, field}, prior_sd));
}

void add_harmonic(Rung& rung, int joint, double order, double prior_sd) {
  std::vector<Harmonic>& harmonics = rung.nominal.joints[joint].harmonics;
  const auto known =
      std::find_if(harmonics.begin(), harmonics.end(), [&](const Harmonic& h) { return h.order == order; });
  const auto term = static_cast<int>(known - harmonics.begin());
  if (known == harmonics.end()) harmonics.push_back({order});
  for (const Field field : {Field::sine, Field::cosine})
    rung.further.push_back(parameter_at(rung.nominal, {Owner::joint, joint, field, term}, prior_sd));
}

double spread(const std::vector<double>& values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  return finite.size() < 2 ? 0.0 : quantile(finite, 0.95) - quantile(finite, 0.05);
}

Rung gains(Rung rung, const CalibrateTask& task) {
  rung.adds = "a gain of each turning joint's encoder";
  free_joint_numbers(rung, Field::gain, task.tolerances.gain, turns_by_reading);
  return rung;
}

/// Turning joints follow the reading of the one or two before them: a parallelogram's or a hollow wrist's transmission.
Rung coupling(Rung rung) {
  rung.adds = "how far each turning joint follows the readings of the two before it (transmissions, parallelograms)";
  for (int j = 0; j < static_cast<int>(rung.nominal.joints.size()); ++j) {
    Joint& joint = rung.nominal.joints[j];
    if (!is_revolute(joint)) continue;
    int before = joint.parent;
    for (int steps = 0; steps < 2 && before >= 0; ++steps, before = rung.nominal.joints[before].parent) {
      const auto known = [&](const Coupling& c) { return c.joint == before; };
      if (turns_by_reading(joint) && turns_by_reading(rung.nominal.joints[before]) &&
          std::none_of(joint.couplings.begin(), joint.couplings.end(), known))
        joint.couplings.push_back({before, 0.0});
    }
    for (int k = 0; k < static_cast<int>(joint.couplings.size()); ++k)
      rung.further.push_back(parameter_at(rung.nominal, {Owner::joint, j, Field::coupling, k}, coupling_prior));
  }
  return rung;
}

Rung gravity(Rung rung, const CalibrateTask& task, const PoseSet& rows) {
  rung.adds = "compliance of each turning joint under gravity";
  const bool payload = std::any_of(rows.payload.begin(), rows.payload.end(), [](double kg) { return kg > 0.0; });
  if (rung.nominal.masses.empty() && !payload) {
    rung.adds = "compliance of each turning joint under gravity, with masses guessed from the lengths of the links";
    rung.nominal = with_guessed_masses(rung.nominal);
  }
  if (rung.nominal.gravity.norm() == 0.0) rung.locked = "gravity is zero in the robot file";
  free_joint_numbers(rung, Field::compliance, task.tolerances.compliance, is_revolute);
  return rung;
}

Rung torques(Rung rung, const CalibrateTask& task, const PoseSet& rows) {
  rung.adds = "compliance of each joint by its measured torque";
  free_joint_numbers(rung, Field::torque_compliance, task.tolerances.compliance, turns_by_reading);
  if (rows.torques.size() == 0) rung.locked = "no joint torques were measured (columns tau1, tau2, …)";
  return rung;
}

Rung gear(Rung rung) {
  rung.adds = "what comes back once and twice a turn of each joint (eccentric gears and encoders)";
  for (int j = 0; j < static_cast<int>(rung.nominal.joints.size()); ++j)
    if (turns_by_reading(rung.nominal.joints[j]))
      for (const double order : {1.0, 2.0}) add_harmonic(rung, j, order, harmonic_prior);
  return rung;
}

Rung spectrum(Rung rung, const PoseSet& rows, const Estimate& fitted) {
  const std::vector<SpectralLine> lines = gear_spectrum(fitted, rows);
  for (const SpectralLine& line : lines) add_harmonic(rung, line.joint, line.order, harmonic_prior);
  rung.adds = "what else the spectrum of the residuals shows";
  if (lines.empty()) rung.locked = "the spectrum of the residuals shows no further line";
  return rung;
}

Rung backlash(Rung rung, const PoseSet& rows) {
  rung.adds = "a shift by the side from which each joint was approached (the order of the rows)";
  if (rows.approach.size() == 0) rung.locked = "the order in which the poses were driven to is not known";
  free_joint_numbers(rung, Field::backlash, backlash_prior,
                     [](const Joint& joint) { return joint.has_reading && joint.type != JointType::fixed; });
  return rung;
}

Rung temperature(Rung rung, const PoseSet& rows) {
  rung.adds = "thermal growth of all lengths";
  constexpr double least_spread = 1.0;  // [K]
  rung.further.push_back(parameter_at(rung.nominal, {Owner::robot, -1, Field::expansion}, expansion_prior));
  if (spread(rows.temperature) < least_spread)
    rung.locked =
        rows.temperature.empty() ? "no temperature was measured" : "the temperature hardly changed (less than 1 K)";
  else if (rung.nominal.reference_temperature == 0.0) {
    std::vector<double> finite;
    for (const double t : rows.temperature)
      if (std::isfinite(t)) finite.push_back(t);
    rung.nominal.reference_temperature = median(finite);
  }
  return rung;
}

}  // namespace

std::vector<std::string> rung_names() {
  return {"gains", "coupling", "gravity", "torques", "gear", "spectrum", "backlash", "temperature"};
}

Rung rung_on(const Chain& nominal, const std::string& name, const CalibrateTask& task, const PoseSet& rows,
             const Estimate& fitted) {
  Rung rung{.name = name, .nominal = nominal};
  if (name == "gains") return gains(rung, task);
  if (name == "coupling") return coupling(rung);
  if (name == "gravity") return gravity(rung, task, rows);
  if (name == "torques") return torques(rung, task, rows);
  if (name == "gear") return gear(rung);
  if (name == "spectrum") return spectrum(rung, rows, fitted);
  if (name == "backlash") return backlash(rung, rows);
  return temperature(rung, rows);
}

}  // namespace kinfer
