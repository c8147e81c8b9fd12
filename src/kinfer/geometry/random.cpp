// SPDX-License-Identifier: Apache-2.0
#include "kinfer/geometry/random.hpp"

namespace kinfer {

Vec3 normal_vector(Rng& rng) {
  const double x = rng.normal(), y = rng.normal(), z = rng.normal();
  return {x, y, z};
}

Vec3 uniform_vector(Rng& rng, double low, double high) {
  const double x = rng.uniform(low, high), y = rng.uniform(low, high), z = rng.uniform(low, high);
  return {x, y, z};
}

Quat random_orientation(Rng& rng) {
  const Vec3 v = normal_vector(rng);
  return Quat(rng.normal(), v.x(), v.y(), v.z()).normalized();
}

}  // namespace kinfer
