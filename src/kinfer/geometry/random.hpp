// SPDX-License-Identifier: Apache-2.0
// Random vectors and orientations. Components are drawn one after the other: arguments of one call may be evaluated in
// any order, so `Vec3(rng.normal(), rng.normal(), rng.normal())` depends on the compiler.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// Independent components in the order x, y, z, each of mean 0 and standard deviation 1.
Vec3 normal_vector(Rng& rng);

/// Independent components in the order x, y, z, each even in [low, high).
Vec3 uniform_vector(Rng& rng, double low, double high);

/// Evenly distributed over all orientations: four independent normals, x, y, z, w, normalised (Muller 1959).
Quat random_orientation(Rng& rng);

}  // namespace kinfer
