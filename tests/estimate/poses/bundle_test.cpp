// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/bundle.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "support/differences.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

ParameterSet paper24(const Chain& chain) {
  return paper_dh_parameters(chain, Tolerances{}).value();
}

TEST(Residuals, JacobianEqualsDifferencesForPointsTargetsAndOrientations) {
  Chain truth = with_table3_errors(er20());
  truth.targets = {{"side", Vec3(0.03, -0.02, 0.05)}};
  PoseSimulation simulation = paper2_poses(6, tracker);
  simulation.measured = Measured::poses;
  PoseSet data = measured(truth, simulation);
  data.targets = {"side"};
  data.points.push_back({.row = 2, .target = 0, .position = Vec3(1, 2, 3), .sd = Vec3(1e-3, 2e-3, 3e-3)});
  Chain nominal = er20();
  nominal.targets = truth.targets;
  const ParameterSet set = all_parameters(nominal, Tolerances{});
  const Weights weights = weights_of(data, Instrument{1e-3, 1e-3, 0});
  const Residuals problem = pose_residuals(nominal, set, data, weights);
  const auto [jacobian, expected] = testing::jacobians(problem, pack(set, nominal));
  EXPECT_LT((jacobian - expected).norm(), 1e-6 * expected.norm());
}

TEST(Bundle, NoiseFreePaperCaseIsFittedToRounding) {
  // Target: a sum of squares of at most 1e-12 mm² over 50 poses.
  const PoseSet data = measured(with_table3_errors(er20()), paper2_poses(50, noise_free));
  const Estimate estimate = fit_bundle(er20(), paper24(er20()), data, noise_free);
  double squares = 0.0;
  for (const double e : point_errors(estimate.chain, data)) squares += e * e;
  EXPECT_LT(squares * 1e6, 1e-12);
  EXPECT_TRUE(estimate.outliers.empty());
}

TEST(Bundle, RanksOfThePapers24ParametersAre20OnTheAxisAnd23OffIt) {
  // Target on the last axis, and off it; sigma 10 µm.
  Chain off_axis = er20();
  off_axis.tool.xyz = Vec3(0.03, 0.02, 0.0);
  for (const auto& [nominal, rank] : {std::pair{er20(), 20}, std::pair{off_axis, 23}}) {
    const PoseSet data = measured(with_table3_errors(nominal), paper2_poses(50, Instrument{.sigma = 10e-6}));
    const Estimate estimate = fit_bundle(nominal, paper24(nominal), data, Instrument{.sigma = 10e-6});
    EXPECT_EQ(estimate.identifiability.rank, rank);
    EXPECT_EQ(estimate.identifiability.undetermined.size(), 24u - rank);
  }
}

TEST(Bundle, ConfoundedParametersAreNamed) {
  const PoseSet data = measured(with_table3_errors(er20()), paper2_poses(50, Instrument{.sigma = 10e-6}));
  const auto groups =
      fit_bundle(er20(), paper24(er20()), data, Instrument{.sigma = 10e-6}).identifiability.undetermined;
  const auto names = [&](Undetermined reason, const std::vector<std::string>& parameters) {
    return std::any_of(groups.begin(), groups.end(), [&](const UndeterminedGroup& group) {
      return group.reason == reason && group.parameters == parameters;
    });
  };
  EXPECT_TRUE(names(Undetermined::confounded, {"d2", "d3"}));
  EXPECT_TRUE(names(Undetermined::no_effect, {"theta6"}));
  EXPECT_TRUE(names(Undetermined::confounded, {"d5", "alpha6"}));
  EXPECT_TRUE(names(Undetermined::confounded, {"theta5", "a6"}));
}

TEST(Bundle, TheCompleteSetWithBaseToolAndBetaHasRank27) {
  Chain nominal = er20();
  nominal.tool.xyz = Vec3(0.03, 0.02, 0.0);
  const PoseSet data = measured(with_table3_errors(nominal), paper2_poses(60, tracker));
  const ParameterSet set = geometric_parameters(nominal, data, Tolerances{});
  EXPECT_EQ(set.free_count(), 34);
  EXPECT_EQ(fit_bundle(nominal, set, data, tracker).identifiability.rank, 27);
}

TEST(Bundle, UnobservableParametersStayNominal) {
  PoseSet data = measured(with_table3_errors(er20()), paper2_poses(50, tracker));
  const Estimate estimate = fit_bundle(er20(), paper24(er20()), data, tracker);
  const auto theta6 =
      std::find_if(estimate.values.begin(), estimate.values.end(), [](auto& p) { return p.name == "theta6"; });
  EXPECT_NEAR(theta6->value, 0.0, 1e-9);
  EXPECT_FALSE(theta6->identifiable);
  EXPECT_NEAR(theta6->sd, 0.1 * degree, 1e-5);  // only the tolerance determines it
}

TEST(Bundle, OutliersAreListedAndDoNotMoveTheResult) {
  const Chain truth = with_table3_errors(er20());
  PoseSet data = measured(truth, paper2_poses(70, tracker));
  std::vector<int> wrong;
  for (int row = 3; row < 70; row += 6) {
    data.points[row].position += Vec3(0.002, -0.003, 0.1 * (row % 5));
    wrong.push_back(row);
  }
  const Estimate estimate = fit_bundle(er20(), paper24(er20()), data, tracker);
  std::vector<int> listed;
  for (const Outlier& outlier : estimate.outliers) listed.push_back(outlier.row);
  EXPECT_EQ(listed, wrong);
  const PoseSet test_poses = measured(truth, paper2_poses(200, noise_free), 99);
  EXPECT_LT(mean(point_errors(estimate.chain, test_poses)), 25e-6);
}

TEST(Bundle, TheNoiseLevelIsEstimatedFromTheResidualsWhereNoInstrumentIsGiven) {
  const Instrument truth{.sigma = 80e-6};
  const PoseSet data = measured(with_table3_errors(er20()), paper2_poses(200, truth));
  const Estimate estimate = fit_bundle(er20(), paper24(er20()), data, std::nullopt);
  EXPECT_NEAR(estimate.sigma, truth.sigma, 0.12 * truth.sigma);  // 200 medians of 3: sd about 4 %
  EXPECT_FALSE(estimate.chi2_per_n.has_value());
}

TEST(Bundle, AnOverlyOptimisticInstrumentShowsInChi2AndWidensTheStandardDeviations) {
  const PoseSet data = measured(with_table3_errors(er20()), paper2_poses(100, Instrument{.sigma = 100e-6}));
  const Estimate honest = fit_bundle(er20(), paper24(er20()), data, Instrument{.sigma = 100e-6});
  const Estimate fooled = fit_bundle(er20(), paper24(er20()), data, Instrument{.sigma = 10e-6});
  EXPECT_NEAR(*honest.chi2_per_n, 1.0, 0.3);
  EXPECT_GT(*fooled.chi2_per_n, 50.0);
  EXPECT_NEAR(fooled.predicted_error, honest.predicted_error, 0.2 * honest.predicted_error);
}

TEST(Bundle, ErrorsOnHeldOutPosesAreAsLargeAsTheCovariancePredicts) {
  // Twenty noise seeds (a study with the same figures is in docs/development/results.md); 50 poses, 10 µm + 5 µm/m.
  const Chain truth = with_table3_errors(er20());
  const PoseSet test_poses = measured(truth, paper2_poses(200, noise_free), 1234);
  std::vector<double> actual(20), predicted(20);
  parallel_for(actual.size(), 0, [&](std::size_t i) {
    const PoseSet data = measured(truth, paper2_poses(50, tracker), static_cast<int>(100 + i));
    const Estimate estimate = fit_bundle(er20(), geometric_parameters(er20(), data, {}), data, tracker);
    actual[i] = rms(point_errors(estimate.chain, test_poses));
    double squares = 0.0;
    for (int row = 0; row < test_poses.rows(); ++row)
      squares += predicted_covariance(estimate, test_poses.joints.col(row)).trace();
    predicted[i] = std::sqrt(squares / static_cast<double>(test_poses.rows()));
  });
  EXPECT_GT(mean(actual) / mean(predicted), 0.8);
  EXPECT_LT(mean(actual) / mean(predicted), 1.25);
  EXPECT_LT(mean(actual), 30e-6);
}

TEST(Bundle, PredictedErrorsOfManyPosesAreThoseOfTheirCovariances) {
  const PoseSet data = measured(with_table3_errors(er20()), paper2_poses(50, tracker));
  Estimate estimate = fit_bundle(er20(), geometric_parameters(er20(), data, {}), data, tracker);
  for (const double compliance : {0.0, 1e-6}) {  // pose by pose where a joint is compliant
    estimate.chain.joints[1].compliance = compliance;
    const VectorXd errors = predicted_errors(estimate, data.joints);
    ASSERT_EQ(errors.size(), data.rows());
    for (Eigen::Index row = 0; row < data.rows(); ++row) {
      const double one = std::sqrt(predicted_covariance(estimate, data.joints.col(row)).trace());
      EXPECT_NEAR(errors[row], one, 1e-10 * one);
    }
  }
}

}  // namespace
}  // namespace kinfer
