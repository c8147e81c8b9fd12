// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/posture_argument.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/possible_range.hpp"

namespace kinfer::cli {
namespace {

/// Of the numbers of joints that turn and of those that slide.
struct JointRanges {
  PossibleRange turns, slides;
};

Result<VectorXd> parse_joint_numbers(const std::string& option, const std::string& text, const Chain& chain,
                                     const JointRanges& ranges, UnknownPosition unknown) {
  const std::vector<int> joints = active_joints(chain);
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = parse_number(std::string_view(text).substr(begin, end - begin));
    if (!number) return error("{}: expected numbers separated by commas, found \"{}\"", option, text);
    numbers.push_back(*number);
    begin = end + 1;
  }
  if (numbers.size() != joints.size())
    return error("{}: the robot has {} joints, found {} numbers", option, joints.size(), numbers.size());
  VectorXd q(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const bool turns = rotates(chain.joints[static_cast<std::size_t>(joints[k])].type);
    const double value = numbers[k] * (turns ? degree : 1e-3);
    const bool is_unknown = std::isnan(value) && unknown == UnknownPosition::allowed;
    if (const auto wrong = impossible(value, turns ? ranges.turns : ranges.slides); wrong && !is_unknown)
      return error("{}: {}", option, *wrong);
    q[static_cast<Eigen::Index>(k)] = value;
  }
  return q;
}

}  // namespace

Result<VectorXd> parse_posture(const std::string& option, const std::string& text, const Chain& chain,
                               UnknownPosition unknown) {
  return parse_joint_numbers(option, text, chain, {possible::angle, possible::length}, unknown);
}

Result<VectorXd> parse_motion_limits(const std::string& option, const std::string& text, const Chain& chain) {
  return parse_joint_numbers(option, text, chain, {possible::motion_limit, possible::motion_limit},
                             UnknownPosition::refused);
}

}  // namespace kinfer::cli
