// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "support/differences.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;
using testing::numeric_jacobian;

/// A revolute, a prismatic and a revolute joint in series, and a fixed body at the root.
struct FactExample {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;
};

FactExample fact_example(const InsFacts& facts) {
  Rng rng(3);
  const auto random_rotation = [&] { return exp_so3(random_vector(rng)); };
  FactExample e;
  e.problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 20};
  e.problem.sensors.resize(5);
  e.problem.facts = facts;
  e.x.bodies = {{.sensor = 0},
                test::random_revolute_body(0, 1, rng),
                test::random_prismatic_body(1, 2, rng),
                test::random_revolute_body(2, 3, rng),
                fixed_body(0, 4, random_rotation())};
  for (InsBody& body : e.x.bodies) {
    body.point_in_parent = random_vector(rng);
    if (body.free_point_in_child) body.point_in_child = random_vector(rng);
  }
  e.x.errors.resize(5);
  e.x.spline_coefficients = MatrixXd(3, e.problem.grid.coefficients());
  for (Index i = 0; i < e.x.spline_coefficients.size(); ++i) e.x.spline_coefficients.data()[i] = rng.normal();
  e.layout = layout_of(e.problem, e.x.bodies);
  e.x.facts = initial_fact_unknowns(e.problem, e.layout, e.x);
  for (auto* points : {&e.x.facts.places, &e.x.facts.touched})
    for (Vec3& point : *points) point += random_vector(rng);
  e.x.facts.surveyor.rotation = e.x.facts.surveyor.rotation * random_rotation();
  return e;
}

InsPoint place(int body, int index) {
  return {InsPoint::Kind::place, body, index};
}

InsFacts every_kind() {
  InsFacts facts;
  facts.places = {{.body = 3}, {.body = 1, .start = Vec3(0.1, 0.2, 0.3), .sd = 0.01}};
  facts.touches = {{place(3, 0), {0.23, 1.71}, 0.01}, {place(1, 1), {0.4, 1.0}, 0.02}};
  using Kind = InsPoint::Kind;
  facts.tapes = {{{Kind::sensor, 0}, {Kind::sensor, 3}, 2.0, 0.01, 0.9},
                 {{Kind::joint_axis, 1}, {Kind::joint_axis, 3}, 2.0, 0.01, 1.2},
                 {{Kind::joint_centre, 3}, {Kind::joint_axis, 1}, 2.0, 0.01, 1.3},
                 {{Kind::joint_axis, 3}, place(3, 0), 2.0, 0.01, 1.4},
                 {{Kind::sensor, 4}, {Kind::joint_axis, 1}, 2.0, 0.01, 0.1}};
  facts.surveyed = {{place(3, 0), 0.3, Vec3(1, 2, 3), 0.01},
                    {place(3, 0), 0.8, Vec3(0, 2, 1), 0.01},
                    {{Kind::sensor, 2}, 1.5, Vec3(-1, 0, 1), 0.02}};
  Rng rng(5);
  facts.closures = {{.first = 4,
                     .second = 3,
                     .start = test::random_revolute_body(0, 1, rng),
                     .at = {0.25, 1.35},
                     .point_sd = 0.01,
                     .axis_sd = 0.02},
                    {.first = 1,
                     .second = 3,
                     .start = test::random_revolute_body(0, 1, rng),
                     .at = {0.75},
                     .point_sd = 0.1,
                     .axis_sd = 0.1}};
  return facts;
}

/// Step: spline coefficients, all dimensions of a time together, in time order; then the global parameters.
InsUnknowns moved(const FactExample& e, ConstVectorRef step) {
  const Index coefficients = e.x.spline_coefficients.size();
  return retract(e.problem, e.layout, e.x,
                 {step.head(coefficients).reshaped(e.x.spline_coefficients.rows(), e.x.spline_coefficients.cols()),
                  step.tail(e.layout.global_parameters),
                  {}});
}

TEST(FactResiduals, DerivativesAgreeWithDifferences) {
  const FactExample e = fact_example(every_kind());
  const auto rows = fact_rows(e.problem, e.layout, e.x);
  ASSERT_EQ(rows.size(), 2U + 2U + 5U + 3U + 2U + 1U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const MatrixXd numeric = numeric_jacobian(
        [&](const VectorXd& step) { return VectorXd(-fact_rows(e.problem, e.layout, moved(e, step))[i].left); },
        VectorXd::Zero(e.x.spline_coefficients.size() + e.layout.global_parameters));
    MatrixXd analytic = MatrixXd::Zero(numeric.rows(), numeric.cols());
    const Index local = spline_order * e.layout.spline_dimensions;
    analytic.middleCols(rows[i].interval * e.layout.spline_dimensions, local) = rows[i].derivative.leftCols(local);
    analytic.rightCols(e.layout.global_parameters) = rows[i].derivative.rightCols(e.layout.global_parameters);
    EXPECT_LT((analytic - numeric).norm(), 1e-5 * (1.0 + numeric.norm())) << "fact " << i;
  }
}

TEST(FactResiduals, TheirCostIsTheSumOfTheSquares) {
  const FactExample e = fact_example(every_kind());
  double sum = 0.0;
  for (const InsFactRows& rows : fact_rows(e.problem, e.layout, e.x)) sum += rows.left.squaredNorm();
  EXPECT_NEAR(fact_cost(e.problem, e.layout, e.x), sum, 1e-9 * sum);
}

TEST(FactResiduals, AClosureIsSatisfiedWhereBothLinesCoincide) {
  InsFacts facts;
  facts.closures = {{.first = 4,
                     .second = 3,
                     .start = revolute_body(0, 1, Mat3::Identity(), Mat3::Identity()),
                     .at = {0.95},
                     .point_sd = 0.01,
                     .axis_sd = 0.02}};
  FactExample e = fact_example(facts);
  const auto at = [&](int body, const Vec3& local) {
    FactExample with_place = e;
    with_place.problem.facts = {.places = {{.body = body, .start = local}}, .touches = {}, .tapes = {}, .surveyed = {}};
    with_place.layout = layout_of(with_place.problem, e.x.bodies);
    with_place.x.facts = initial_fact_unknowns(with_place.problem, with_place.layout, e.x);
    return point_position(with_place.problem, with_place.layout, with_place.x, place(body, 0), 0.95);
  };
  const auto pose_of = [&](int body) {
    const Vec3 origin = at(body, Vec3::Zero());
    Mat3 rotation;
    for (int k = 0; k < 3; ++k) rotation.col(k) = at(body, Vec3::Unit(k)) - origin;
    return Pose{rotation, origin};
  };
  const Pose first = pose_of(4), second = pose_of(3);
  const Vec3 point(0.3, -0.2, 0.5), axis = Vec3(1.0, 2.0, -0.5).normalized();  // in the root
  InsBody& joint = e.x.facts.closures[0];
  joint.point_in_parent = first.inverse() * point;
  joint.point_in_child = second.inverse() * point;
  joint.parent_R_axis = frame_with_z_along(first.rotation.transpose() * axis);
  joint.child_R_axis = frame_with_z_along(second.rotation.transpose() * axis);
  EXPECT_LT(fact_cost(e.problem, e.layout, e.x), 1e-16);
  joint.point_in_child += second.rotation.transpose() * Vec3(0.02, 0.0, 0.0);
  EXPECT_NEAR(fact_cost(e.problem, e.layout, e.x), 4.0, 1e-9) << "two standard deviations of 10 mm";
  joint.point_in_child = second.inverse() * point;
  joint.child_R_axis = joint.child_R_axis * rot_x(0.02);
  EXPECT_NEAR(fact_cost(e.problem, e.layout, e.x), 1.0, 1e-3) << "one standard deviation of 20 mrad";
}

TEST(FactResiduals, ATapeBetweenAxesIsTheirShortestDistance) {
  FactExample e = fact_example(every_kind());
  const InsTapeDistance& tape = e.problem.facts.tapes[1];
  const auto rows = fact_rows(e.problem, e.layout, e.x);
  const double predicted = tape.length - tape.sd * rows[5].left[0];
  // Reference: sample both lines.
  InsBodies& bodies = e.x.bodies;
  const auto along = [&](std::size_t body, double metres) {
    const Vec3 kept = bodies[body].point_in_parent;
    bodies[body].point_in_parent += metres * bodies[body].parent_R_axis.col(2);
    const Vec3 at =
        point_position(e.problem, e.layout, e.x, {InsPoint::Kind::joint_centre, static_cast<int>(body)}, tape.at);
    bodies[body].point_in_parent = kept;
    return at;
  };
  double least = 1e9;
  for (double a = -8.0; a <= 8.0; a += 0.02)
    for (double b = -8.0; b <= 8.0; b += 0.5) {
      // The nearest point of the second line to a point of the first, in closed form along that line only.
      const Vec3 p = along(1, a), q = along(3, b), unit = (along(3, b + 1.0) - q).normalized();
      least = std::min(least, (p - q - unit * unit.dot(p - q)).norm());
    }
  EXPECT_NEAR(predicted, least, 1e-3);
}

TEST(FactResiduals, TouchesAreOneAndTheSamePointInTheRoot) {
  const FactExample e = fact_example(every_kind());
  const auto rows = fact_rows(e.problem, e.layout, e.x);
  const InsRevisitedPoint& touch = e.problem.facts.touches[0];
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 at = point_position(e.problem, e.layout, e.x, touch.point, touch.at[i]);
    EXPECT_LT((at + touch.sd * rows[i].left - e.x.facts.touched[0]).norm(), 1e-12);
  }
}

TEST(FactResiduals, AMeasuredAxisIsOneThatATapeATouchOrASurveyEndsAt) {
  using Kind = InsPoint::Kind;
  const InsPoint axis{Kind::joint_axis, 2}, centre{Kind::joint_centre, 2}, sensor{Kind::sensor, 0};
  InsFacts facts;
  facts.tapes = {{.from = sensor, .to = centre}};
  EXPECT_FALSE(is_measured_axis(facts, 2));
  facts.tapes = {{.from = axis, .to = sensor}};
  EXPECT_TRUE(is_measured_axis(facts, 2));
  EXPECT_FALSE(is_measured_axis(facts, 0));
  facts.tapes = {{.from = sensor, .to = axis}};
  EXPECT_TRUE(is_measured_axis(facts, 2));
  InsFacts touched, surveyed;
  touched.touches = {{.point = axis, .at = {}}};
  surveyed.surveyed = {{.point = axis}};
  EXPECT_TRUE(is_measured_axis(touched, 2));
  EXPECT_TRUE(is_measured_axis(surveyed, 2));
}

}  // namespace
}  // namespace kinfer
