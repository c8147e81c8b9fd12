// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/prediction/unobserved_tool.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/parameters/parameter_sets.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// Position and rotation of every tool, with the tolerances as priors.
ParameterSet tool_parameters(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set = all_parameters(chain, tolerances);
  const ParameterSet setup = setup_parameters(chain, tolerances);
  set.parameters.insert(set.parameters.end(), setup.parameters.begin(), setup.parameters.end());
  std::erase_if(set.parameters, [](const Parameter& p) {
    const auto* number = std::get_if<FrameNumber>(&p.at);
    return !number || number->frame != SetupFrame::tool;
  });
  return set;
}

bool is_estimated(const PredictionModel& model, const Parameter& parameter) {
  return std::ranges::find(model.parameters, parameter.name) != model.parameters.end();
}

/// Rotations that no measurement depends on, of tools whose position is estimated.
std::vector<Parameter> unobserved_rotations(const PredictionModel& model, const Chain& chain,
                                            const Tolerances& tolerances, const PoseSet& data) {
  const ParameterSet tools = tool_parameters(chain, tolerances), observed = frame_parameters(chain, data, tolerances);
  std::vector<Parameter> unobserved;
  for (const Parameter& parameter : tools.parameters) {
    if (!is_rotation(*field_of(parameter.at)) || observed.find(parameter.name)) continue;
    const bool is_of_estimated_tool = std::ranges::any_of(tools.parameters, [&](const Parameter& other) {
      return std::get<FrameNumber>(other.at).mounting == std::get<FrameNumber>(parameter.at).mounting &&
             is_estimated(model, other);
    });
    if (is_of_estimated_tool && std::isfinite(parameter.prior_sd)) unobserved.push_back(parameter);
  }
  return unobserved;
}

}  // namespace

PredictionModel with_unobserved_tools(PredictionModel model, const Chain& chain, const Tolerances& tolerances,
                                      const PoseSet& data) {
  const std::vector<Parameter> more = unobserved_rotations(model, chain, tolerances, data);
  const Index known = model.root.rows(), all = known + static_cast<Index>(more.size());
  MatrixXd root = MatrixXd::Zero(all, all);
  root.topLeftCorner(known, known) = model.root;
  for (Index k = known; k < all; ++k) {
    const Parameter& rotation = more[static_cast<std::size_t>(k - known)];
    model.parameters.push_back(rotation.name);
    root(k, k) = rotation.prior_sd;
  }
  model.root = std::move(root);
  if (model.beyond.size() > 0) {
    model.beyond.conservativeResize(all);
    model.beyond.tail(all - known).setZero();
  }
  return model;
}

}  // namespace kinfer::calibrate
