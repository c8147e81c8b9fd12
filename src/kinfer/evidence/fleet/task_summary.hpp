// SPDX-License-Identifier: Apache-2.0
// The result of one task of a sweep in a few numbers: what a merge reads instead of the whole evidence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/evidence/facts/verdict.hpp"
#include "kinfer/kinematics/parameter_address.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct SummaryFigure {
  std::string name{};  ///< with its unit where it has one: "holdout_rms_m"
  double value = 0.0;  ///< SI
};

struct SummaryParameter {
  std::string name{};  ///< as in robot files: "theta2"
  Quantity quantity = Quantity::length;
  double nominal = 0.0, value = 0.0, sd = 0.0;  ///< SI
  std::optional<double> truth{};                ///< where it is known
};

/// What the measurements of one robot say about its joint parameters, without any prior and with base, tool and all
/// other parameters marginalised: a Gaussian likelihood exp(−½ uᵀ Λ u + hᵀ u) in u = (x − nominal) / tolerance.
struct ParameterInformation {
  std::vector<std::string> names{};
  VectorXd nominal{}, tolerance{};  ///< n, SI
  MatrixXd information{};           ///< Λ, n x n, symmetric; semidefinite where poses are few
  VectorXd vector{};                ///< h, n
};

struct TaskSummary {
  std::string verb{};
  std::optional<Usability> usability{};
  std::string reason{};  ///< its stable name: "improves_nominal", "frames_moved"
  std::vector<SummaryFigure> figures{};
  std::vector<std::string> findings{};  ///< kinds, each once, in the order of the evidence
  std::vector<SummaryParameter> parameters{};
  std::optional<ParameterInformation> information{};
};

}  // namespace kinfer
