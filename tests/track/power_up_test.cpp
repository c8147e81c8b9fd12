// SPDX-License-Identifier: Apache-2.0
// Biases that are still those of the identification, and others since a power-up.
#include "kinfer/track/start/power_up.hpp"

#include <gtest/gtest.h>

#include "tracked_case.hpp"

namespace kinfer::track {
namespace {

constexpr InsLevel bias_of_grade{3.5e-3, 9.8e-3};  // [rad/s], [m/s²] industrial

/// Sensors without biases, of a grade that has some.
const Case& unbiased_excavator(Base base) {
  const auto made = [](Base on) {
    Case result = make_case({.grade = "noise", .base = on, .duration = 20.0});
    result.model.prior.bias = bias_of_grade;
    return result;
  };
  static const Case still = made(Base::still), rocking = made(Base::rocking);
  return base == Base::still ? still : rocking;
}

/// [1] The share of a power-up's change that is left after the start, where each bias has changed by so many standard
/// deviations of the grade.
InsLevel share_left(const Case& given, const InsLevel& changed_by) {
  Rng rng(5);
  std::vector<InsSample> offset(given.model.sensors.size());
  for (InsSample& of : offset)
    for (Index k = 0; k < 3; ++k) {
      of.angular_velocity[k] = changed_by.rate * bias_of_grade.rate * rng.normal();
      of.acceleration[k] = changed_by.force * bias_of_grade.force * rng.normal();
    }
  Tracker tracker(given.model);
  const InsLevel expected = tracker.filter().model().power_up;
  InsRow row;
  for (std::size_t r = 0; r < 100; ++r) {
    test::fill_row(given.drive.recording, r, row);
    for (std::size_t s = 0; s < offset.size(); ++s) {
      row.sensors[s].angular_velocity += offset[s].angular_velocity;
      row.sensors[s].acceleration += offset[s].acceleration;
    }
    tracker.add(row);
  }
  EXPECT_TRUE(tracker.state().started);
  const InsLevel left = tracker.filter().model().power_up;
  return {std::sqrt(left.rate / expected.rate), std::sqrt(left.force / expected.force)};
}

TEST(PowerUp, BiasesThatHaveNotChangedAreKnownAsTheyWereHandedOver) {
  for (const Base base : {Base::still, Base::rocking}) {
    const InsLevel left = share_left(unbiased_excavator(base), {0.0, 0.0});
    EXPECT_LT(left.rate, 0.1);
    EXPECT_LT(left.force, 0.3);
  }
}

TEST(PowerUp, BiasesThatHaveChangedAreNotBelieved) {
  for (const Base base : {Base::still, Base::rocking}) {
    const InsLevel left = share_left(unbiased_excavator(base), {0.5, 1.0});
    EXPECT_GT(left.rate, 0.9);
    EXPECT_GT(left.force, 0.7);
  }
}

TEST(PowerUp, GyroscopesThatAreZeroedSayLittleOfTheAccelerometers) {
  EXPECT_GT(share_left(unbiased_excavator(Base::still), {0.0, 1.0}).force, 0.7);
}

}  // namespace
}  // namespace kinfer::track
