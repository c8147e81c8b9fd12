// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/base_speed.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {

BaseSpeed::BaseSpeed() : mean_square_(square(first_base_speed)) {}

void BaseSpeed::add(const Vec3& velocity, const Vec3& variance, double length) {
  now_ = velocity.squaredNorm() / 3.0;
  observed_ += length;
  const double memory = std::min(base_speed_memory, base_speed_prior + observed_);
  mean_square_ += (now_ + variance.sum() / 3.0 - mean_square_) * std::min(1.0, length / memory);
}

double BaseSpeed::sd() const {
  return std::max(least_base_speed, std::sqrt(std::max(mean_square_, now_)));
}

}  // namespace kinfer::track
