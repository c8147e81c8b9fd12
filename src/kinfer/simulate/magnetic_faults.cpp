// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/magnetic_faults.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/geometry/random.hpp"

namespace kinfer {
namespace {

constexpr double transient_spacing = 10.0;                           // [s] mean
constexpr double shortest_transient = 2.0, longest_transient = 6.0;  // [s]

}  // namespace

std::vector<Vec3> with_iron(std::vector<Vec3> field, double hard, double soft, Rng rng) {
  const Vec3 bias = hard * normal_vector(rng).normalized();
  Mat3 scale = Mat3::Identity();
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      const double element = soft * rng.normal();
      scale(i, j) += element;
      if (i != j) scale(j, i) += element;
    }
  for (Vec3& f : field) f = scale * f + bias;
  return field;
}

std::vector<Vec3> with_transients(std::vector<Vec3> field, double size, double step, Rng rng) {
  const double duration = step * static_cast<double>(field.size());
  const int count = std::max(1, static_cast<int>(std::round(duration / transient_spacing)));
  for (int i = 0; i < count; ++i) {
    const Vec3 peak = size * normal_vector(rng).normalized();
    const double length = rng.uniform(shortest_transient, longest_transient),
                 begin = rng.uniform(0.0, std::max(step, duration - length));
    for (std::size_t row = 0; row < field.size(); ++row) {
      const double phase = (step * static_cast<double>(row) - begin) / length;
      if (phase > 0.0 && phase < 1.0) field[row] += 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * phase)) * peak;
    }
  }
  return field;
}

}  // namespace kinfer
