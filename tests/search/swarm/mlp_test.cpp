// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/mlp.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/search/swarm/objective.hpp"
#include "search/swarm_problems.hpp"
#include "support/differences.hpp"

namespace kinfer {
namespace {

using testing::cube;

Mlp small_net() {
  return initialise_mlp(cube(3, 2.0), cube(2, 5.0), 4, Rng(1));
}

TEST(Mlp, PredictionIsEquation12WrittenOut) {
  const Mlp net = small_net();
  const VectorXd x = (VectorXd(3) << 0.5, -1.5, 1.9).finished();
  const MatrixXd predicted = predict(net, x);
  for (int out = 0; out < 2; ++out) {
    double sum = -net.output_thresholds[out];
    for (int h = 0; h < 4; ++h) {
      double inner = -net.hidden_thresholds[h];
      for (int j = 0; j < 3; ++j) inner += net.hidden_weights(h, j) * x[j] / 2.0;
      sum += net.output_weights(out, h) * std::tanh(inner);
    }
    EXPECT_NEAR(predicted(out, 0), 5.0 * sum, 1e-12);
  }
}

TEST(Mlp, GradientOfBackPropagationAgreesWithDifferences) {
  const Mlp net = small_net();
  const MatrixXd inputs = uniform_swarm(net.input_box, 9, Rng(2)), targets = uniform_swarm(net.output_box, 9, Rng(3));
  const auto loss = [&](const VectorXd& w) {
    return VectorXd::Constant(1, loss_and_gradient(with_weights(net, w), inputs, targets).loss);
  };
  const MatrixXd numeric = testing::numeric_jacobian(loss, weights_of(net));
  EXPECT_TRUE(loss_and_gradient(net, inputs, targets).gradient.isApprox(numeric.transpose(), 1e-7));
}

TEST(Mlp, BothTrainersLearnANonlinearFunction) {
  const Bounds in = cube(1, 2.0), out = cube(1, 1.0);
  const MatrixXd x = uniform_swarm(in, 100, Rng(4));
  const MatrixXd y = x.array().sin();
  for (const Trainer& trainer : {Trainer(BackPropagation{.rate = 0.1}), Trainer(Adam{.rate = 0.01})}) {
    const Training training = train(initialise_mlp(in, out, 12, Rng(5)), x, y, {.trainer = trainer, .epochs = 3000});
    EXPECT_LT(training.error.back(), 0.03);
    EXPECT_LT(training.error.back(), 0.2 * training.error.front());
    EXPECT_NEAR(predict(training.net, MatrixXd::Constant(1, 1, 1.0))(0, 0), std::sin(1.0), 0.08);
  }
}

TEST(Mlp, TrainingEndsAtTheTargetError) {
  const MatrixXd x = uniform_swarm(cube(3, 2.0), 20, Rng(6)), y = MatrixXd::Constant(2, 20, 1.0);
  const Training training = train(small_net(), x, y, {.epochs = 5000, .target_error = 0.05});
  EXPECT_LE(training.error.back(), 0.05);
  EXPECT_GT(training.error[training.error.size() - 2], 0.05);
}

TEST(Mlp, ThePapersFormulaGives8To17NodesFor24ParametersAndNever70) {
  EXPECT_EQ(hidden_nodes_by_formula(24, 24, 1), 8);
  EXPECT_EQ(hidden_nodes_by_formula(24, 24, 10), 17);
}

TEST(Mlp, TheStepwiseTrialRejectsTwoNodesForAWave) {
  const Bounds in = cube(1, 1.0), out = cube(1, 1.0);
  const MatrixXd x = uniform_swarm(in, 60, Rng(7));
  const MatrixXd y = (6.0 * x.array()).sin();
  const TrainingOptions options{.trainer = Adam{.rate = 0.02}, .epochs = 2000};
  const auto trials = compare_hidden_nodes(in, out, x, y, {1, 20}, options, 1, Rng(8));
  EXPECT_GT(trials[0].validation_error, 3.0 * trials[1].validation_error);
  EXPECT_EQ(trials[1].nodes, 20);
}

TEST(Mlp, ANetReadBackFromItsTextPredictsTheSameBits) {
  const Mlp net = small_net();
  const auto back = parse_mlp(format_mlp(net), "net.txt");
  ASSERT_TRUE(back) << back.error().what;
  const MatrixXd x = uniform_swarm(net.input_box, 5, Rng(9));
  EXPECT_EQ(predict(*back, x), predict(net, x));
}

TEST(Mlp, ADamagedTextIsRefusedWithItsPosition) {
  std::string text = format_mlp(small_net());
  EXPECT_EQ(
      parse_mlp("kinfer-net/1 51541 51541 2 272 27", "net.txt").error().what,
      "net.txt: the header states 51541 inputs, 51541 hidden nodes and 2 outputs, for which the file is too short");
  EXPECT_EQ(parse_mlp("something else", "net.txt").error().what,
            "net.txt: expected a network file written by kinfer: \"kinfer-net/1\" and three sizes");
  text.resize(text.size() - 30);
  EXPECT_EQ(parse_mlp(text, "net.txt").error().what, "net.txt: expected the numbers of output_thresholds");
}

TEST(Mlp, ANumberThatCannotVaryIsPredictedExactly) {
  Bounds out = cube(2, 1.0);
  out.lower[1] = out.upper[1] = 7.0;
  const Mlp net = initialise_mlp(cube(3, 1.0), out, 4, Rng(1));
  EXPECT_EQ(predict(net, VectorXd::Ones(3))(1, 0), 7.0);
}

}  // namespace
}  // namespace kinfer
