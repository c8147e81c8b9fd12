#include "kinfer/search/mlp.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/search/objective.hpp"
#include "search/swarm_problems.hpp"
#include "support/differences.hpp"

namespace kinfer {
namespace {

using testing::cube;

Mlp small_net() {
  return untrained_mlp(cube(3, 2.0), cube(2, 5.0), 4, Rng(1));
}

TEST(Mlp, prediction_is_equation_12_written_out) {
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

TEST(Mlp, gradient_of_back_propagation_agrees_with_differences) {
  const Mlp net = small_net();
  const MatrixXd inputs = uniform_swarm(net.input_box, 9, Rng(2)), targets = uniform_swarm(net.output_box, 9, Rng(3));
  const auto loss = [&](const VectorXd& w) {
    return VectorXd::Constant(1, loss_and_gradient(with_weights(net, w), inputs, targets).loss);
  };
  const MatrixXd numeric = testing::numeric_jacobian(loss, weights_of(net));
  EXPECT_TRUE(loss_and_gradient(net, inputs, targets).gradient.isApprox(numeric.transpose(), 1e-7));
}

TEST(Mlp, both_trainers_learn_a_bent_function) {
  const Bounds in = cube(1, 2.0), out = cube(1, 1.0);
  const MatrixXd x = uniform_swarm(in, 100, Rng(4));
  const MatrixXd y = x.array().sin();
  for (const Trainer& trainer : {Trainer(BackPropagation{.rate = 0.1}), Trainer(Adam{.rate = 0.01})}) {
    const Training training = train(untrained_mlp(in, out, 12, Rng(5)), x, y, {.trainer = trainer, .epochs = 3000});
    EXPECT_LT(training.error.back(), 0.03);
    EXPECT_LT(training.error.back(), 0.2 * training.error.front());
    EXPECT_NEAR(predict(training.net, MatrixXd::Constant(1, 1, 1.0))(0, 0), std::sin(1.0), 0.08);
  }
}

TEST(Mlp, training_ends_at_the_error_that_was_asked_for) {
  const MatrixXd x = uniform_swarm(cube(3, 2.0), 20, Rng(6)), y = MatrixXd::Constant(2, 20, 1.0);
  const Training training = train(small_net(), x, y, {.epochs = 5000, .target_error = 0.05});
  EXPECT_LE(training.error.back(), 0.05);
  EXPECT_GT(training.error[training.error.size() - 2], 0.05);
}

TEST(Mlp, the_papers_formula_gives_8_to_17_nodes_for_24_parameters_and_never_70) {
  EXPECT_EQ(hidden_nodes_by_formula(24, 24, 1), 8);
  EXPECT_EQ(hidden_nodes_by_formula(24, 24, 10), 17);
}

TEST(Mlp, the_stepwise_trial_sees_that_two_nodes_are_too_few_for_a_wave) {
  const Bounds in = cube(1, 1.0), out = cube(1, 1.0);
  const MatrixXd x = uniform_swarm(in, 60, Rng(7));
  const MatrixXd y = (6.0 * x.array()).sin();
  const TrainingOptions options{.trainer = Adam{.rate = 0.02}, .epochs = 2000};
  const auto trials = try_hidden_nodes(in, out, x, y, {1, 20}, options, 1, Rng(8));
  EXPECT_GT(trials[0].unseen_error, 3.0 * trials[1].unseen_error);
  EXPECT_EQ(trials[1].nodes, 20);
}

TEST(Mlp, a_net_read_back_from_its_text_predicts_the_same_bits) {
  const Mlp net = small_net();
  const auto back = parse_mlp(mlp_text(net), "net.txt");
  ASSERT_TRUE(back) << back.error().what;
  const MatrixXd x = uniform_swarm(net.input_box, 5, Rng(9));
  EXPECT_EQ(predict(*back, x), predict(net, x));
}

TEST(Mlp, a_damaged_text_is_refused_with_the_place) {
  std::string text = mlp_text(small_net());
  EXPECT_EQ(parse_mlp("something else", "net.txt").error().what,
            "net.txt: expected a net that kinfer wrote: \"kinfer-net/1\" and three sizes");
  text.resize(text.size() - 30);
  EXPECT_EQ(parse_mlp(text, "net.txt").error().what, "net.txt: expected the numbers of output_thresholds");
}

TEST(Mlp, a_number_that_cannot_vary_is_predicted_exactly) {
  Bounds out = cube(2, 1.0);
  out.lower[1] = out.upper[1] = 7.0;
  const Mlp net = untrained_mlp(cube(3, 1.0), out, 4, Rng(1));
  EXPECT_EQ(predict(net, VectorXd::Ones(3))(1, 0), 7.0);
}

}  // namespace
}  // namespace kinfer
