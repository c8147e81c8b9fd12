#include "kinfer/calibrate/fleet_prior.hpp"

#include <cmath>
#include <vector>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {

namespace {

/// Where the free parameters that belong to the robot stand, and how far each may be off by its tolerance.
struct RobotNumbers {
  std::vector<Eigen::Index> index;
  std::vector<Address> address;
  VectorXd mean, tolerance;
};

RobotNumbers robot_numbers(const ParameterSet& set) {
  RobotNumbers numbers;
  std::vector<double> mean, tolerance;
  const auto free = set.free();
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (free[k]->at.owner != Owner::joint || !std::isfinite(free[k]->prior_sd)) continue;
    numbers.index.push_back(static_cast<Eigen::Index>(k));
    numbers.address.push_back(free[k]->at);
    mean.push_back(free[k]->nominal), tolerance.push_back(free[k]->prior_sd);
  }
  numbers.mean = Eigen::Map<const VectorXd>(mean.data(), static_cast<Eigen::Index>(mean.size()));
  numbers.tolerance = Eigen::Map<const VectorXd>(tolerance.data(), static_cast<Eigen::Index>(tolerance.size()));
  return numbers;
}

/// Rows whose square is the exponent of a Gaussian of this covariance: the inverse's Cholesky factor, transposed.
MatrixXd root_of_inverse(const MatrixXd& covariance) {
  const auto inverse = inverse_positive(covariance);
  KINFER_EXPECT(inverse, "the tolerances make every fleet's covariance positive definite");
  return cholesky(*inverse)->transpose();
}

}  // namespace

ParameterSet with_fleet_prior(ParameterSet set, std::span<const Chain> fleet) {
  if (fleet.empty()) return set;
  const RobotNumbers numbers = robot_numbers(set);
  const Eigen::Index n = numbers.mean.size();
  const double count = 1.0 + static_cast<double>(fleet.size());
  MatrixXd off(n, static_cast<Eigen::Index>(fleet.size()));  // in tolerances
  for (std::size_t robot = 0; robot < fleet.size(); ++robot)
    for (Eigen::Index i = 0; i < n; ++i)
      off(i, static_cast<Eigen::Index>(robot)) =
          (value_at(fleet[robot], numbers.address[i]) - numbers.mean[i]) / numbers.tolerance[i];
  const VectorXd shift = off.rowwise().sum() / count;
  off.colwise() -= shift;
  const MatrixXd covariance = (MatrixXd::Identity(n, n) + off * off.transpose()) / count;
  const MatrixXd root = root_of_inverse(covariance) * numbers.tolerance.cwiseInverse().asDiagonal();

  set.prior_root = prior_rows(set);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) set.prior_root(numbers.index[i], numbers.index[j]) = root(i, j);
  Eigen::Index i = 0;
  for (Parameter& parameter : set.parameters) {
    if (i == n || !parameter.free || !(parameter.at == numbers.address[i])) continue;
    parameter.nominal += shift[i] * numbers.tolerance[i];
    parameter.prior_sd = std::sqrt(covariance(i, i)) * numbers.tolerance[i];
    ++i;
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
