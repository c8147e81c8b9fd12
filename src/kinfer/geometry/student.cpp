// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/student.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {

double student_upper_tail(double t, int n) {
  if (t < 0.0) return 1.0 - student_upper_tail(-t, n);
  const double angle = std::atan(t / std::sqrt(n)), c = std::cos(angle), s = std::sin(angle);
  double sum = 0.0, term = n % 2 == 0 ? 1.0 : c;
  for (int k = n % 2 == 0 ? 2 : 3; k <= n; k += 2) {
    sum += term;
    term *= c * c * (k - 1) / k;
  }
  const double inside = n % 2 == 0 ? s * sum : 2.0 / std::numbers::pi * (angle + (n > 1 ? s * sum : 0.0));
  return std::max(0.5 * (1.0 - inside), 1e-12);
}

double gaussian_of_student(double t, int n) {
  const double size = std::abs(t);
  constexpr int many = 60;
  const double z = n > many ? (8.0 * n + 1.0) / (8.0 * n + 3.0) * std::sqrt(n * std::log1p(size * size / n))
                            : -normal_quantile(student_upper_tail(size, n));
  return std::copysign(z, t);
}

}  // namespace kinfer
