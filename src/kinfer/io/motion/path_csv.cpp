// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/motion/path_csv.hpp"

#include <fmt/format.h>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {

std::string format_path_csv(const TimedPath& path, const std::vector<bool>& rotational) {
  std::string text = "t[s]";
  for (const auto& [name, per] : {std::pair{"q", ""}, std::pair{"qd", "/s"}, std::pair{"qdd", "/s^2"}})
    for (std::size_t k = 0; k < rotational.size(); ++k)
      text += fmt::format(",{}{}[{}{}]", name, k + 1, rotational[k] ? "deg" : "mm", per);
  text += '\n';
  for (std::size_t i = 0; i < path.time.size(); ++i) {
    text += format_number(path.time[i]);
    for (const MatrixXd* of : {&path.position, &path.velocity, &path.acceleration})
      for (std::size_t k = 0; k < rotational.size(); ++k)
        text += ',' + format_number((*of)(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)),
                                    rotational[k] ? degree : 1e-3);
    text += '\n';
  }
  return text;
}

}  // namespace kinfer
