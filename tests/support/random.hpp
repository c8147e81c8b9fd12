// Random things that more than one test needs.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer::test {

/// Of unit variance an axis.
inline Vec3 random_vector(Rng& rng) {
  const double x = rng.normal(), y = rng.normal(), z = rng.normal();
  return {x, y, z};
}

}  // namespace kinfer::test
