// SPDX-License-Identifier: Apache-2.0
// Fits y = a exp(b t) to samples with two outliers, with and without a robust loss.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "kinfer/search/least_squares/least_squares.hpp"
#include "kinfer/words/status.hpp"

namespace {

constexpr double noise = 0.02;  // standard deviation of a sample
constexpr std::array samples{2.01, 1.63, 1.35, 9.00, 0.89,
                             0.75, 0.60, 5.00, 0.41, 0.33};  // 2 exp(-2 t) at t = 0, 0.1 ...

kinfer::Residuals decay() {
  kinfer::Residuals problem{.unknowns = 2, .rows = samples.size(), .blocks = std::vector<int>(samples.size(), 1)};
  problem.evaluate = [](kinfer::ConstVectorRef x, kinfer::VectorXd& r, kinfer::MatrixXd* jacobian) {
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const double t = 0.1 * static_cast<double>(i), e = std::exp(x[1] * t);
      r[i] = (x[0] * e - samples[i]) / noise;
      if (jacobian) jacobian->row(i) << e / noise, x[0] * t * e / noise;
    }
  };
  return problem;
}

}  // namespace

int main() {
  const Eigen::Vector2d start(1.0, -1.0);
  const auto plain = kinfer::least_squares(decay(), start);
  const auto robust = kinfer::least_squares(decay(), start, {.loss = kinfer::Loss::cauchy, .loss_scale = 2.0});
  fmt::print("plain   a = {:7.4f}, b = {:7.4f}; {}\n", plain.x[0], plain.x[1], kinfer::words::sentence(plain.stop));
  fmt::print("cauchy  a = {:7.4f}, b = {:7.4f}; {}\n", robust.x[0], robust.x[1], kinfer::words::sentence(robust.stop));
  fmt::print("weights of the samples:");
  for (const double weight : robust.block_weights) fmt::print(" {:.2f}", weight);
  fmt::print("\n");
  const bool found = std::abs(robust.x[0] - 2.0) < 0.02 && std::abs(robust.x[1] + 2.0) < 0.02;
  return found ? 0 : 1;
}
