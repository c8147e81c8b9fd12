// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/rotation_vector_motion.hpp"

#include <cmath>

namespace kinfer {
namespace {

struct Factors {
  double c1, c2, d1, d2, e1, e2;
};

Factors factors(double square) {
  if (square < 0.04) {
    const double s = square, ss = square * square;
    return {0.5 - s / 24 + ss / 720,           1.0 / 6 - s / 120 + ss / 5040,    -1.0 / 12 + s / 180 - ss / 6720,
            -1.0 / 60 + s / 1260 - ss / 60480, 1.0 / 90 - s / 1680 + ss / 75600, 1.0 / 630 - s / 15120 + ss / 831600};
  }
  const double t = std::sqrt(square), sine = std::sin(t), cosine = std::cos(t), fourth = square * square;
  Factors f{};
  f.c1 = (1.0 - cosine) / square;
  f.c2 = (t - sine) / (t * square);
  f.d1 = (t * sine - 2.0 + 2.0 * cosine) / fourth;
  f.d2 = (3.0 * sine - 2.0 * t - t * cosine) / (t * fourth);
  f.e1 = (t * cosine - sine) / (t * fourth) - 4.0 * f.d1 / square;
  f.e2 = (f.d1 - 5.0 * f.d2) / square;
  return f;
}

/// Derivative of J v by φ.
Mat3 jacobian_change(const Factors& f, const Vec3& p, const Vec3& v) {
  const Vec3 pv = p.cross(v), ppv = p.cross(pv);
  return f.c1 * skew(v) - f.c2 * (skew(pv) + skew(p) * skew(v)) + (f.d2 * ppv - f.d1 * pv) * p.transpose();
}

}  // namespace

RotationVectorMotion rotation_vector_motion(const Vec3& p, const Vec3& v, const Vec3& a) {
  const Factors f = factors(p.squaredNorm());
  const Mat3 cross = skew(p);
  const double s = p.dot(v);
  const Vec3 pv = p.cross(v), ppv = p.cross(pv), vpv = v.cross(pv);
  RotationVectorMotion r;
  r.jacobian = Mat3::Identity() - f.c1 * cross + f.c2 * cross * cross;
  r.angular_velocity = r.jacobian * v;
  r.angular_acceleration = r.jacobian * a - f.d1 * s * pv + f.d2 * s * ppv + f.c2 * vpv;
  r.velocity_by_vector = jacobian_change(f, p, v);
  const Mat3 sv = skew(v), pv_by_p = -sv, ppv_by_p = -skew(pv) - cross * sv;
  r.acceleration_by_vector = jacobian_change(f, p, a) - pv * (f.e1 * s * p + f.d1 * v).transpose() -
                             f.d1 * s * pv_by_p + ppv * (f.e2 * s * p + f.d2 * v).transpose() + f.d2 * s * ppv_by_p +
                             f.d2 * vpv * p.transpose() + f.c2 * sv * pv_by_p;
  r.acceleration_by_velocity = (f.d2 * ppv - f.d1 * pv) * p.transpose() - f.d1 * s * cross + f.d2 * s * cross * cross +
                               f.c2 * (sv * cross - skew(pv));
  return r;
}

}  // namespace kinfer
