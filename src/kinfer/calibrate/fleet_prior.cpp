#include "kinfer/calibrate/fleet_prior.hpp"

#include <cmath>

namespace kinfer {

ParameterSet with_fleet_prior(ParameterSet set, std::span<const Chain> fleet) {
  if (fleet.empty()) return set;
  const double count = 1.0 + static_cast<double>(fleet.size());
  for (Parameter& parameter : set.parameters) {
    if (parameter.at.owner != Owner::joint) continue;
    double sum = parameter.nominal;
    for (const Chain& robot : fleet) sum += value_at(robot, parameter.at);
    const double mean = sum / count;
    double squares = parameter.prior_sd * parameter.prior_sd;
    for (const Chain& robot : fleet) squares += std::pow(value_at(robot, parameter.at) - mean, 2);
    parameter.nominal = mean;
    parameter.prior_sd = std::sqrt(squares / count);
  }
  return set;
}

Chain with_joint_numbers_of(const Chain& chain, const Chain& earlier, const ParameterSet& set) {
  Chain result = chain;
  for (const Parameter& parameter : set.parameters)
    if (parameter.at.owner == Owner::joint) set_value_at(result, parameter.at, value_at(earlier, parameter.at));
  return result;
}

bool same_kind(const Chain& a, const Chain& b) {
  if (a.joints.size() != b.joints.size()) return false;
  for (std::size_t j = 0; j < a.joints.size(); ++j)
    if (a.joints[j].type != b.joints[j].type || a.joints[j].link.index() != b.joints[j].link.index()) return false;
  return true;
}

}  // namespace kinfer
