// SPDX-License-Identifier: Apache-2.0
// A periodic cubic spline over one revolution, as coefficients of its knots and as harmonics.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::calibrate {

/// Knots of the spline over one revolution, and the highest order kept of it: all but 0.4 % of its amplitude.
struct Resolution {
  int knots = 0, order = 0;
};
inline constexpr std::array<Resolution, 3> resolutions{{{32, 24}, {63, 47}, {126, 94}}};

/// Of the resolution with that highest order; 0 where there is none.
int knots_for(int order);

/// The harmonics of orders 0 to `highest` of a spline with coefficients at knots 2π k / n.
std::vector<Harmonic> harmonics_of(const VectorXd& coefficients, int highest);

/// The coefficients of the spline that the first harmonics of a joint came from.
VectorXd coefficients_of(const std::vector<Harmonic>& harmonics, int knots);

/// The four knots that act at a joint position.
struct ActingKnots {
  std::array<int, 4> knot;
  std::array<double, 4> weight;
};

/// `position` in rad.
inline ActingKnots knots_at(double position, int knots) {
  const double along = position * knots / (2.0 * std::numbers::pi), below = std::floor(along), t = along - below,
               u = 1.0 - t;
  const auto first = static_cast<int>(std::fmod(below, knots)) - 1;
  ActingKnots acting{
      {}, {u * u * u / 6.0, 2.0 / 3.0 - t * t + 0.5 * t * t * t, 2.0 / 3.0 - u * u + 0.5 * u * u * u, t * t * t / 6.0}};
  for (int k = 0; k < 4; ++k) acting.knot[k] = ((first + k) % knots + knots) % knots;
  return acting;
}

}  // namespace kinfer::calibrate
