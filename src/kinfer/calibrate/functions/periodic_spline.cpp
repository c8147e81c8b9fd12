// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/periodic_spline.hpp"

#include <cmath>
#include <numbers>

namespace kinfer::calibrate {
namespace {

/// The part of a harmonic that a cubic B-spline passes: the fourth power of sin(x) / x.
double passed(int order, int knots) {
  const double x = std::numbers::pi * order / knots;
  return order == 0 ? 1.0 : std::pow(std::sin(x) / x, 4.0);
}

/// Sines and cosines of 2π k / n.
struct Circle {
  std::vector<double> sine, cosine;

  explicit Circle(int n) {
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / n;
      sine.push_back(std::sin(angle)), cosine.push_back(std::cos(angle));
    }
  }
};

}  // namespace

int knots_for(int order) {
  for (const Resolution& r : resolutions)
    if (r.order == order) return r.knots;
  return 0;
}

std::vector<Harmonic> harmonics_of(const VectorXd& coefficients, int highest) {
  const auto knots = static_cast<int>(coefficients.size());
  const Circle circle(knots);
  std::vector<Harmonic> list;
  for (int order = 0; order <= highest; ++order) {
    Harmonic h{static_cast<double>(order)};
    for (int k = 0; k < knots; ++k) {
      const auto at = static_cast<std::size_t>(order * k % knots);
      h.sine += coefficients[k] * circle.sine[at], h.cosine += coefficients[k] * circle.cosine[at];
    }
    const double scale = (order == 0 ? 1.0 : 2.0) / knots * passed(order, knots);
    h.sine *= scale, h.cosine *= scale;
    list.push_back(h);
  }
  return list;
}

VectorXd coefficients_of(const std::vector<Harmonic>& harmonics, int knots) {
  const Circle circle(knots);
  VectorXd coefficients = VectorXd::Zero(knots);
  for (int order = 0; 2 * order <= knots; ++order) {
    const Harmonic& h = harmonics[static_cast<std::size_t>(order)];
    const double scale = (2 * order == knots ? 0.5 : 1.0) / passed(order, knots);
    for (int k = 0; k < knots; ++k) {
      const auto at = static_cast<std::size_t>(order * k % knots);
      coefficients[k] += scale * (h.sine * circle.sine[at] + h.cosine * circle.cosine[at]);
    }
  }
  return coefficients;
}

}  // namespace kinfer::calibrate
