// SPDX-License-Identifier: Apache-2.0
// The geometry of a machine in two tracking models, parameter by parameter, and the causes of the differences.
#pragma once

#include "kinfer/identify/update/chain_changes.hpp"

namespace kinfer::identify {

/// `fresh` less `known` in the parameters that both estimate, zeros excepted, and the sum of their covariances.
struct GeometryDifference {
  std::vector<TrackingParameter> parameters;
  VectorXd value;
  MatrixXd covariance;
};
GeometryDifference geometry_difference(const TrackingModel& known, const TrackingModel& fresh);

struct FoundCause {
  ChainCause cause;
  VectorXd size;  ///< components of the cause
  ChainChange change;
};

struct ChainComparison {
  ChainUpdate update;
  std::vector<FoundCause> causes;  ///< of its changes, in their order
  TrackingModel moved;             ///< the known machine after these changes
};

/// Both of the same structure, in the same order.
ChainComparison compare_chains(const TrackingModel& known, const TrackingModel& fresh);

}  // namespace kinfer::identify
