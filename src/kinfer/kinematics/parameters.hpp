// SPDX-License-Identifier: Apache-2.0
// The parameters of a chain: ONE list defines names, units, nominal values, scales, bounds, free or fixed, and priors.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/kinematics/parameter_address.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct Parameter {
  std::string name{};  ///< docs/formats.md: "a6" (rows from 1), "theta2", "gain3", "base_x", "tool_rz", "x4" and
                       ///< "rx4" (URDF joints), "coupling3_2" (how far joint 3 follows the position of joint 2)
  Quantity quantity = Quantity::length;
  ParameterAddress at;
  double nominal = 0.0;
  double scale = 1.0;  ///< size of a typical error, > 0: conditions the search
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double prior_sd = std::numeric_limits<double>::infinity();  ///< of a Gaussian prior about nominal; infinity: none
  bool free = true;
};

/// Expected deviation of the true values from the nominal ones, one sigma. SI.
struct Tolerances {
  double length = 0.5e-3;       ///< [m]
  double angle = 0.1 * degree;  ///< [rad]
  double base_length = 50e-3;   ///< [m]
  double base_angle = 2 * degree;
  double tool_length = 2e-3;  ///< [m]
  double tool_angle = 2 * degree;
  double gain = 5e-4;
  double compliance = 5e-6;  ///< [rad/(N m)]
  double anchor = 5e-3;      ///< [m]
};

struct ParameterSet {
  std::vector<Parameter> parameters;
  /// Square-root information of a joint Gaussian prior on the free parameters, in place of their prior_sd: cost
  /// |prior_sqrt_information · (x − nominal)|², n x n in the order of pack. Empty: prior_sd holds. Invalid if another
  /// one is freed.
  MatrixXd prior_sqrt_information{};

  Eigen::Index free_count() const;
  const Parameter* find(std::string_view name) const;  ///< null where there is none
  std::vector<const Parameter*> free() const;          ///< in the order of pack
};

/// Every number of the chain that can be estimated, all free, with nominal, scale and prior from the tolerances:
/// base (x y z rx ry rz), each joint on the path to a tip (a alpha d theta beta gain compliance, or x y z rx ry rz
/// gain compliance for URDF joints; gain only for active joints; compliance only for revolute joints; the
/// couplings that it has), tool.
ParameterSet all_parameters(const Chain& chain, const Tolerances& tolerances);

/// Base, tool and joints of the further mountings (base only where they have one of their own), targets and fixtures.
/// Frames, targets and the fixtures whose kind has FixturePrior::tolerance have priors.
ParameterSet setup_parameters(const Chain& chain, const Tolerances& tolerances);

/// One parameter by its address, named, with the value in the chain as nominal and `prior_sd` as prior and scale.
Parameter parameter_at(const Chain& chain, const ParameterAddress& at, double prior_sd);

/// Frees the named parameters and fixes all others. Programming error if a name is unknown.
ParameterSet with_only_free(ParameterSet set, const std::vector<std::string>& names);

/// Square-root information of the priors: their residuals at x are rows · (x − nominal), n x n for n free parameters. A
/// parameter without a prior has a row of zeros.
MatrixXd prior_sqrt_information_of(const ParameterSet& set);

/// Nominal numbers of the free parameters, in order.
VectorXd nominal_of(const ParameterSet& set);

/// Values of the free parameters, in order.
VectorXd pack(const ParameterSet& set, const Chain& chain);

/// `nominal` with the free parameters replaced by x.
Chain unpack(const ParameterSet& set, const Chain& nominal, ConstVectorRef x);

/// Every number that a calibration may free, by its name: what two chains have in common, whatever the order of their
/// terms.
std::map<std::string, ParameterAddress> addresses_by_name(const Chain& chain);

}  // namespace kinfer
