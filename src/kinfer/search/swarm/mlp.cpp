// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/mlp.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"

namespace kinfer {
namespace {

/// Maps a box to −1 .. 1; a number with an empty range maps to 0.
MatrixXd scaled(ConstMatrixRef x, const Bounds& box) {
  const VectorXd half = box.half_width();
  const VectorXd factor = (half.array() > 0.0).select(half.cwiseInverse(), VectorXd::Zero(half.size()));
  return factor.asDiagonal() * (x.colwise() - box.center());
}

MatrixXd unscaled(ConstMatrixRef y, const Bounds& box) {
  return (box.half_width().asDiagonal() * y).colwise() + box.center();
}

void hidden_layer(const Mlp& net, ConstMatrixRef scaled_inputs, MatrixXd& hidden) {
  hidden.noalias() = net.hidden_weights * scaled_inputs;
  hidden.colwise() -= net.hidden_thresholds;
  for (double& sum : hidden.reshaped()) sum = std::tanh(sum);
}

void output_layer(const Mlp& net, const MatrixXd& hidden, MatrixXd& output) {
  output.noalias() = net.output_weights * hidden;
  output.colwise() -= net.output_thresholds;
}

/// Visits the four weight arrays in the order of the flat weight vector.
template <class Net, class Visitor>
void for_each_array(Net& net, Visitor visit) {
  visit(net.hidden_weights.reshaped());
  visit(net.hidden_thresholds.reshaped());
  visit(net.output_weights.reshaped());
  visit(net.output_thresholds.reshaped());
}

/// Back-propagation over all pairs. The layers are kept between epochs: an allocator that returns arrays of this size
/// to the system each time makes threads wait for each other.
class Backward {
 public:
  LossAndGradient operator()(const Mlp& net, const MatrixXd& x, const MatrixXd& wanted) {
    const auto pairs = static_cast<double>(x.cols());
    hidden_layer(net, x, hidden_);
    output_layer(net, hidden_, error_);
    error_ -= wanted;
    const double loss = 0.5 * error_.squaredNorm() / pairs;
    error_ /= pairs;
    at_hidden_.noalias() = net.output_weights.transpose() * error_;
    at_hidden_.array() *= 1.0 - hidden_.array().square();
    gradient_.hidden_weights.noalias() = at_hidden_ * x.transpose();
    gradient_.hidden_thresholds = -at_hidden_.rowwise().sum();
    gradient_.output_weights.noalias() = error_ * hidden_.transpose();
    gradient_.output_thresholds = -error_.rowwise().sum();
    return {loss, weights_of(gradient_)};
  }

 private:
  MatrixXd hidden_, error_, at_hidden_;
  Mlp gradient_;
};

/// Step of back-propagation with momentum.
VectorXd step(const BackPropagation& how, const VectorXd& gradient, int, VectorXd& last, VectorXd&) {
  last = how.momentum * last - how.rate * gradient;
  return last;
}

VectorXd step(const Adam& how, const VectorXd& gradient, int epoch, VectorXd& mean, VectorXd& square) {
  mean = how.decay1 * mean + (1.0 - how.decay1) * gradient;
  square = how.decay2 * square + (1.0 - how.decay2) * gradient.cwiseAbs2();
  const double bias1 = 1.0 - std::pow(how.decay1, epoch + 1), bias2 = 1.0 - std::pow(how.decay2, epoch + 1);
  return (-how.rate / bias1) * (mean.array() / ((square / bias2).array().sqrt() + 1e-8)).matrix();
}

double rms_of(double loss, Eigen::Index outputs) {
  return std::sqrt(2.0 * loss / static_cast<double>(outputs));
}

MatrixXd columns(ConstMatrixRef x, const std::vector<Eigen::Index>& which) {
  return x(Eigen::all, which);
}

}  // namespace

MatrixXd predict(const Mlp& net, ConstMatrixRef x) {
  KINFER_EXPECT(x.rows() == net.hidden_weights.cols(), "{} numbers for a net of {} inputs", x.rows(),
                net.hidden_weights.cols());
  MatrixXd hidden, output;
  hidden_layer(net, scaled(x, net.input_box), hidden);
  output_layer(net, hidden, output);
  return unscaled(output, net.output_box);
}

Mlp initialise_mlp(const Bounds& input_box, const Bounds& output_box, int hidden_nodes, Rng rng) {
  Mlp net{input_box,
          output_box,
          MatrixXd(hidden_nodes, input_box.size()),
          VectorXd(hidden_nodes),
          MatrixXd(output_box.size(), hidden_nodes),
          VectorXd(output_box.size())};
  const auto fill = [&](auto array, double reach) {
    for (double& w : array) w = rng.uniform(-reach, reach);
  };
  const double first = 1.0 / std::sqrt(static_cast<double>(input_box.size()));
  const double second = 1.0 / std::sqrt(static_cast<double>(hidden_nodes));
  fill(net.hidden_weights.reshaped(), first);
  fill(net.hidden_thresholds.reshaped(), first);
  fill(net.output_weights.reshaped(), second);
  fill(net.output_thresholds.reshaped(), second);
  return net;
}

VectorXd weights_of(const Mlp& net) {
  Eigen::Index count = 0;
  for_each_array(net, [&](const auto& array) { count += array.size(); });
  VectorXd weights(count);
  Eigen::Index at = 0;
  for_each_array(net, [&](const auto& array) {
    weights.segment(at, array.size()) = array;
    at += array.size();
  });
  return weights;
}

Mlp with_weights(Mlp net, ConstVectorRef weights) {
  Eigen::Index at = 0;
  for_each_array(net, [&](auto array) {
    array = weights.segment(at, array.size());
    at += array.size();
  });
  return net;
}

LossAndGradient loss_and_gradient(const Mlp& net, ConstMatrixRef inputs, ConstMatrixRef targets) {
  return Backward()(net, scaled(inputs, net.input_box), scaled(targets, net.output_box));
}

Training train(Mlp net, ConstMatrixRef inputs, ConstMatrixRef targets, const TrainingOptions& options) {
  KINFER_EXPECT(inputs.cols() == targets.cols() && inputs.cols() > 0, "{} inputs, {} targets", inputs.cols(),
                targets.cols());
  const MatrixXd x = scaled(inputs, net.input_box), wanted = scaled(targets, net.output_box);
  VectorXd weights = weights_of(net);
  VectorXd state1 = VectorXd::Zero(weights.size()), state2 = state1;
  Training training;
  Backward backward;
  for (int epoch = 0;; ++epoch) {
    const LossAndGradient at = backward(net, x, wanted);
    training.error.push_back(rms_of(at.loss, wanted.rows()));
    if (epoch == options.epochs || training.error.back() <= options.target_error) break;
    weights +=
        std::visit([&](const auto& how) { return step(how, at.gradient, epoch, state1, state2); }, options.trainer);
    net = with_weights(std::move(net), weights);
  }
  training.net = std::move(net);
  return training;
}

int hidden_nodes_by_formula(Eigen::Index inputs, Eigen::Index outputs, int a) {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(inputs + outputs)))) + a;
}

std::vector<NodeTrial> compare_hidden_nodes(const Bounds& input_box, const Bounds& output_box, ConstMatrixRef inputs,
                                            ConstMatrixRef targets, const std::vector<int>& candidates,
                                            const TrainingOptions& options, int threads, Rng rng) {
  std::vector<Eigen::Index> kept, held_out;
  for (Eigen::Index i = 0; i < inputs.cols(); ++i) (i % 5 == 4 ? held_out : kept).push_back(i);
  KINFER_EXPECT(!held_out.empty(), "{} pairs are too few for a trial", inputs.cols());
  const MatrixXd kept_x = columns(inputs, kept), kept_y = columns(targets, kept);
  const MatrixXd held_out_x = columns(inputs, held_out), held_out_y = columns(targets, held_out);
  std::vector<NodeTrial> trials(candidates.size());
  parallel_for(candidates.size(), threads, [&](std::size_t i) {
    const Mlp start = initialise_mlp(input_box, output_box, candidates[i], rng.stream(candidates[i]));
    const Training training = train(start, kept_x, kept_y, options);
    const double validation_loss = loss_and_gradient(training.net, held_out_x, held_out_y).loss;
    trials[i] = {candidates[i], training.error.back(), rms_of(validation_loss, output_box.size())};
  });
  return trials;
}

}  // namespace kinfer
