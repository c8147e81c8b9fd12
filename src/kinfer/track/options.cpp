// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/options.hpp"

#include <fmt/format.h>

#include "kinfer/base/angle.hpp"

namespace kinfer::track {
namespace {

std::string_view name(BaseMotion base) {
  switch (base) {
    case BaseMotion::automatic:
      return "auto";
    case BaseMotion::still:
      return "still";
    case BaseMotion::moving:
      return "moving";
  }
  return {};
}

/// "0,-31.5,nan"
std::string start_text(const VectorXd& start, const TrackingModel& model) {
  std::string text;
  for (const TrackingJoint& joint : model.joints)
    for (Eigen::Index k = joint.first_position; k < joint.first_position + joint.positions; ++k)
      text += fmt::format("{}{:.10g}", text.empty() ? "" : ",",
                          start[k] / (joint.type == EstimatedJointType::prismatic ? 1e-3 : degree));
  return text;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> describe(const TrackOptions& options, Estimator estimator,
                                                          const TrackingModel& model) {
  return {{"--base", std::string(name(options.base))},
          {"--smooth", estimator == Estimator::smoother ? "yes" : "no"},
          {"--start", options.start ? start_text(*options.start, model) : ""}};
}

}  // namespace kinfer::track
