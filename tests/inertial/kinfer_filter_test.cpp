#include "kinfer/inertial/kinfer_filter.hpp"

#include <gtest/gtest.h>

#include "kinfer/inertial/orientation.hpp"
#include "kinfer/inertial/orientation_error.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer {
namespace {

using testing::carried;
using testing::CarriedSensor;

KinferVector unit(int state, double size) {
  KinferVector v = KinferVector::Zero();
  v[state] = size;
  return v;
}

TEST(KinferBelief, difference_undoes_correction) {
  KinferBelief belief;
  belief.world_q_sensor = quat_exp(Vec3(0.3, -0.4, 1.0));
  KinferVector error;
  for (int i = 0; i < kinfer_states; ++i) error[i] = 0.01 * (i + 1);
  EXPECT_LT((difference(corrected(belief, error), belief) - error).norm(), 1e-12);
}

/// What predict() says of the end of a period, against filters that really start with another bias or scale.
TEST(KinferFilter, transition_agrees_with_differences) {
  const CarriedSensor c = carried({.seconds = 8.0, .rest = 0.0, .has_magnetometer = false});
  const auto one_period = [&](const KinferVector& error, KinferTransition* transition) {
    KinferFilterOptions options{.update_period = 0.05};
    KinferFilter filter(options);
    const std::size_t first = 800;
    filter.add(sample(c.sensor, c.time, first));
    filter.believe(corrected(filter.belief(), error));
    std::size_t row = first + 1;
    while (!filter.update_is_due()) filter.integrate(sample(c.sensor, c.time, row++));
    const KinferTransition t = filter.predict();
    if (transition) *transition = t;
    return filter.belief();
  };
  KinferTransition transition;
  const KinferBelief nominal = one_period(KinferVector::Zero(), &transition);
  constexpr double h = 1e-5;
  for (int state = 0; state < 12; ++state) {
    const KinferVector change = difference(one_period(unit(5 + state, h), nullptr), nominal) / h;
    EXPECT_LT((change.head<3>() - transition.by_constants.col(state)).norm(), 2e-3 * 0.05) << "constant " << state;
  }
  for (int axis = 0; axis < 2; ++axis) {
    const KinferVector change = difference(one_period(unit(axis, h), nullptr), nominal) / h;
    EXPECT_NEAR(change[3], axis == 1 ? transition.lift : 0.0, 1e-3);
    EXPECT_NEAR(change[4], axis == 0 ? -transition.lift : 0.0, 1e-3);
    EXPECT_NEAR(change[axis], 1.0, 1e-6);
  }
}

TEST(KinferFilter, covariance_by_blocks_is_that_of_the_full_matrices) {
  const CarriedSensor c = carried({.seconds = 8.0, .rest = 0.0});
  KinferFilter filter;
  for (std::size_t row = 0; row < c.time.size(); ++row) {
    filter.integrate(sample(c.sensor, c.time, row));
    if (!filter.update_is_due()) continue;
    const KinferCovariance before = filter.covariance();
    const KinferTransition t = filter.predict();
    KinferCovariance f = KinferCovariance::Identity();
    f.block<3, 12>(0, 5) = t.by_constants;
    f(3, 1) = t.lift, f(4, 0) = -t.lift;
    const KinferCovariance full = f * before * f.transpose() + KinferCovariance(t.noise.asDiagonal());
    ASSERT_LT((full - filter.covariance()).norm(), 1e-12 * full.norm()) << "row " << row;
    filter.correct();
  }
}

TEST(KinferFilter, gyro_bias_is_found_at_rest_and_in_motion) {
  for (const double rest : {4.0, 0.0}) {
    CarriedSensor c = carried({.seconds = 60.0, .rest = rest, .has_magnetometer = false});
    const Vec3 bias(0.006, -0.005, 0.004);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (float& w : c.sensor.rate.axis[axis]) w += static_cast<float>(bias[static_cast<Eigen::Index>(axis)]);
    KinferFilter filter;
    for (std::size_t row = 0; row < 55 * 200; ++row) filter.add(sample(c.sensor, c.time, row));
    EXPECT_LT((filter.belief().bias - bias).norm(), (rest > 0 ? 0.01 : 0.1) * degree) << rest << " s of rest";
  }
}

TEST(KinferFilter, a_large_machine_is_followed_as_well_as_a_hand) {
  const CarriedSensor hand = carried({.has_magnetometer = false});
  const CarriedSensor crane = carried({.seconds = 120.0, .reach = 8.0, .pace = 0.2, .has_magnetometer = false});
  for (const CarriedSensor* c : {&hand, &crane}) {
    const auto q = orientations(c->sensor, c->time, KinferFilterOptions{});
    EXPECT_LT(orientation_error(q, c->truth, std::vector<char>(q.size(), 1)).inclination, 0.5 * degree);
  }
}

TEST(KinferFilter, a_slow_steady_turn_is_not_taken_for_a_bias) {
  CarriedSensor c = carried({.seconds = 60.0, .rate = 100.0, .rest = 1000.0, .has_magnetometer = false});
  const double rate = 1.0 * degree;  // about up, from 20 s to 28 s
  for (std::size_t row = 2000; row < 2800; ++row) {
    const Vec3 up = c.truth[row].conjugate() * Vec3::UnitZ();
    for (std::size_t axis = 0; axis < 3; ++axis) c.sensor.rate.axis[axis][row] += static_cast<float>(rate * up[axis]);
  }
  const auto q = orientations(c.sensor, c.time, KinferFilterOptions{});
  EXPECT_NEAR(q[1990].angularDistance(q[2790]), 8 * rate, 0.1 * rate * 8);
}

TEST(KinferFilter, a_magnet_nearby_for_ten_seconds_does_not_turn_the_heading) {
  CarriedSensor c = carried({.seconds = 60.0});
  for (std::size_t row = 30 * 200; row < 40 * 200; ++row) {
    const Vec3 disturbance = c.truth[row].conjugate() * Vec3(25, 0, 10);
    for (std::size_t axis = 0; axis < 3; ++axis)
      c.sensor.field.axis[axis][row] += static_cast<float>(disturbance[axis]);
  }
  const auto q = orientations(c.sensor, c.time, KinferFilterOptions{});
  double worst = 0.0;
  for (std::size_t row = 30 * 200; row < 40 * 200; ++row) worst = std::max(worst, q[row].angularDistance(c.truth[row]));
  EXPECT_LT(worst, 2.5 * degree) << "the field was turned by 50 degrees";
}

TEST(KinferFilter, a_field_that_changed_for_good_is_learned_in_minutes) {
  CarriedSensor c = carried({.seconds = 240.0, .rate = 100.0, .rest = 2.0});
  const Vec3 now = 1.4 * (rot_z(0.5) * Vec3(0, 20.5, -44));
  for (std::size_t row = 60 * 100; row < c.time.size(); ++row) {
    const Vec3 field = c.truth[row].conjugate() * now;
    for (std::size_t axis = 0; axis < 3; ++axis) c.sensor.field.axis[axis][row] = static_cast<float>(field[axis]);
  }
  const auto q = orientations(c.sensor, c.time, KinferFilterOptions{});
  EXPECT_GT(q[230 * 100].angularDistance(c.truth[230 * 100]), 0.35) << "of the 0.5 rad that it changed by";
}

TEST(KinferFilter, a_copy_goes_on_where_the_original_was) {
  const CarriedSensor c = carried({.seconds = 12.0});
  KinferFilter filter;
  for (std::size_t row = 0; row < 1000; ++row) filter.add(sample(c.sensor, c.time, row));
  KinferFilter copy = filter;
  for (std::size_t row = 1000; row < c.time.size(); ++row) {
    filter.add(sample(c.sensor, c.time, row));
    copy.add(sample(c.sensor, c.time, row));
  }
  EXPECT_TRUE(filter.orientation().coeffs() == copy.orientation().coeffs());
  EXPECT_LE(sizeof(KinferFilter), 4096u);
}

}  // namespace
}  // namespace kinfer
