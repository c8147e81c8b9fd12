// SPDX-License-Identifier: Apache-2.0
// What steel does to a magnetometer: iron of the segment that carries it, which moves with the sensor, and iron that
// passes by.
#pragma once

#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// (I + S) m + b at every time: |b| = `hard` in a random direction, S symmetric with elements of standard deviation
/// `soft`.
std::vector<Vec3> with_iron(std::vector<Vec3> field, double hard, double soft, Rng rng);

/// Adds about one smooth bump in ten seconds, each of 2 to 6 s and with its peak `size` in a random direction. `step`
/// [s]: between the entries.
std::vector<Vec3> with_transients(std::vector<Vec3> field, double size, double step, Rng rng);

}  // namespace kinfer
