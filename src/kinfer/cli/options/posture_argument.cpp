// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/posture_argument.hpp"

#include <algorithm>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/possible_range.hpp"

namespace kinfer::cli {

Result<VectorXd> parse_posture(const std::string& option, const std::string& text, const Chain& chain) {
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
    if (const auto wrong = impossible(value, turns ? possible::angle : possible::length))
      return error("{}: {}", option, *wrong);
    q[static_cast<Eigen::Index>(k)] = value;
  }
  return q;
}

}  // namespace kinfer::cli
