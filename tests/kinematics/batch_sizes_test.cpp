// SPDX-License-Identifier: Apache-2.0
// The batch kernels at every number of points and candidates that their lanes, blocks and chunks treat differently.
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/batch/batch_points.hpp"
#include "kinfer/kinematics/batch/batch_population.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/products.hpp"
#include "laws/example_chains.hpp"
#include "support/kernels.hpp"

namespace kinfer {
namespace {

/// An arm with errors and a second target, measured at random.
struct BatchCase {
  Chain chain = laws::er20_with_errors();
  ParameterSet set;
  PointTable table;

  BatchCase(int points, const std::vector<std::string>& free) {
    chain.targets = {{"second", Vec3(0.01, 0.2, -0.03)}};
    set = with_only_free(all_parameters(chain, {}), free);
    Rng rng(17);
    table.joints = MatrixXd::NullaryExpr(6, points, [&] { return rng.uniform(-2.5, 2.5); });
    table.measured = Eigen::Matrix3Xd::NullaryExpr(3, points, [&] { return rng.normal(); });
    for (int i = 0; i < points; ++i) table.target.push_back(i % 4 == 3 ? 0 : -1);
  }
  VectorXd candidate(std::uint64_t seed) const {
    Rng rng(seed);
    return pack(set, chain).unaryExpr([&](double v) { return v + 0.02 * rng.normal(); });
  }
  /// Sum of squared errors, one pose after the other.
  double slow_sum_at(const VectorXd& x) const {
    const Chain changed = unpack(set, chain, x);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < table.measured.cols(); ++i) {
      const int target = table.target[static_cast<std::size_t>(i)];
      const Vec3 on_tool = target < 0 ? Vec3(Vec3::Zero()) : changed.targets[0].xyz;
      sum += (Vec3(table.measured.col(i)) - forward(changed, table.joints.col(i)) * on_tool).squaredNorm();
    }
    return sum;
  }
};

const std::vector<std::string> some_numbers{"base_x", "base_rz", "a2",    "alpha3", "theta4",
                                            "beta2",  "d5",      "gain6", "tool_y"};

TEST(BatchSizes, AnyNumberOfPointsGivesTheCostOfTheWalk) {
  for (const int points : {1, 2, 3, 7, 8, 9, 15, 16, 17, 63, 64, 65, 130}) {
    const BatchCase c(points, some_numbers);
    const VectorXd x = c.candidate(3);
    const double slow = c.slow_sum_at(x);
    for (const batch::Kernels* kernels : test::kernels_to_run()) {
      const BatchPoints batch(c.chain, c.set, c.table, *kernels);
      const auto weights = batch.weights(Eigen::Matrix3Xd::Ones(3, points));
      BatchPoints::Scratch scratch;
      EXPECT_NEAR(batch.cost(x, weights, scratch), slow, 1e-12 * slow) << kernels->name << ' ' << points;
      MatrixXd matrix, jacobian(3 * points, batch.unknowns());
      VectorXd gradient, r(3 * points);
      EXPECT_NEAR(batch.normal_equations(x, weights, matrix, gradient, scratch), slow, 1e-12 * slow);
      batch.residuals(x, weights, r, jacobian, scratch);
      const MatrixXd expected = gram(jacobian).triangularView<Eigen::Lower>();
      EXPECT_LE((matrix - expected).norm(), 1e-12 * expected.norm()) << kernels->name << ' ' << points;
      EXPECT_LE((gradient - jacobian.transpose() * r).norm(), 1e-12 * jacobian.norm() * r.norm());
    }
  }
}

TEST(BatchSizes, AnyNumberOfCandidatesGivesTheirOwnSums) {
  const BatchCase c(11, some_numbers);
  for (const int candidates : {1, 2, 7, 8, 9, 16, 31, 33}) {
    MatrixXd x(c.set.free_count(), candidates);
    for (int k = 0; k < candidates; ++k) x.col(k) = c.candidate(static_cast<std::uint64_t>(100 + k));
    for (const batch::Kernels* kernels : test::kernels_to_run()) {
      std::vector<double> sums(static_cast<std::size_t>(candidates));
      BatchPopulation<double>(c.chain, c.set, c.table, *kernels).sums(x, sums);
      for (int k = 0; k < candidates; ++k) {
        const double slow = c.slow_sum_at(x.col(k));
        EXPECT_NEAR(sums[static_cast<std::size_t>(k)], slow, 1e-12 * slow) << kernels->name << ' ' << candidates;
      }
    }
  }
}

TEST(BatchSizes, NothingFreeIsTheNominalChain) {
  const BatchCase c(9, {});
  const double slow = c.slow_sum_at(VectorXd());
  for (const batch::Kernels* kernels : test::kernels_to_run()) {
    std::vector<double> sum(1);
    BatchPopulation<double>(c.chain, c.set, c.table, *kernels).sums(MatrixXd(0, 1), sum);
    EXPECT_NEAR(sum[0], slow, 1e-12 * slow) << kernels->name;
  }
}

TEST(BatchSizes, ACandidateThatIsNoNumberSpoilsItsOwnSumOnly) {
  const BatchCase c(11, some_numbers);
  MatrixXd x(c.set.free_count(), 9);
  for (int k = 0; k < 9; ++k) x.col(k) = c.candidate(static_cast<std::uint64_t>(k));
  x(2, 4) = std::nan("");
  for (const batch::Kernels* kernels : test::kernels_to_run()) {
    std::vector<double> sums(9);
    BatchPopulation<double>(c.chain, c.set, c.table, *kernels).sums(x, sums);
    for (int k = 0; k < 9; ++k) EXPECT_EQ(std::isfinite(sums[static_cast<std::size_t>(k)]), k != 4) << kernels->name;
  }
}

TEST(BatchSizes, AFixedBaseOnEitherSideOfTheErrorGivesTheSameSum) {
  // With the base fixed, the kernels measure errors in the base's frame: sums of squares are the same.
  const BatchCase fixed(21, {"a2", "theta4"}), free(21, {"a2", "theta4", "base_x"});
  VectorXd x(2), with_base(3);
  x << 0.8, -0.05;
  with_base << fixed.chain.base.xyz.x(), 0.8, -0.05;
  std::vector<double> a(1), b(1);
  BatchPopulation<double>(fixed.chain, fixed.set, fixed.table).sums(x, a);
  BatchPopulation<double>(free.chain, free.set, free.table).sums(with_base, b);
  EXPECT_NEAR(a[0], b[0], 1e-12 * a[0]);
}

TEST(BatchSizes, PointsWithoutWeightDoNotCount) {
  const BatchCase c(19, some_numbers);
  BatchCase last = c;
  last.table = {c.table.joints.rightCols(1), c.table.measured.rightCols(1), {c.table.target.back()}};
  Eigen::Matrix3Xd inverse_sd = Eigen::Matrix3Xd::Ones(3, 19);
  inverse_sd.col(18).setZero();
  BatchPoints points(c.chain, c.set, c.table);
  const BatchPoints moved = std::move(points);
  BatchPoints::Scratch scratch;
  const VectorXd x = c.candidate(1);
  const double expected = c.slow_sum_at(x) - last.slow_sum_at(x);
  EXPECT_NEAR(moved.cost(x, moved.weights(inverse_sd), scratch), expected, 1e-12 * expected);
}

}  // namespace
}  // namespace kinfer
