// SPDX-License-Identifier: Apache-2.0
// A multilayer perceptron with one hidden layer, paper 2, eq. (12):  P = f(Σ_j w_ij x_j − T_j)
//
// f is the hyperbolic tangent in the hidden layer and the identity in the output layer. Numbers are scaled to −1 .. 1
// by the boxes of inputs and outputs, and back.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/types.hpp"
#include "kinfer/search/swarm/bounds.hpp"

namespace kinfer {

struct Mlp {
  Bounds input_box{}, output_box{};  ///< ranges that are scaled to −1 .. 1
  MatrixXd hidden_weights{};         ///< hidden x inputs
  VectorXd hidden_thresholds{};      ///< hidden
  MatrixXd output_weights{};         ///< outputs x hidden
  VectorXd output_thresholds{};      ///< outputs

  Eigen::Index hidden_nodes() const { return hidden_thresholds.size(); }
};

/// Outputs of the network, one column for each column of x (inputs x n).
MatrixXd predict(const Mlp& net, ConstMatrixRef x);

/// Weights uniform in ±1/√(number of inputs of the layer), thresholds likewise.
Mlp initialise_mlp(const Bounds& input_box, const Bounds& output_box, int hidden_nodes, Rng rng);

/// Gradient descent on the mean error with momentum: the back-propagation of paper 2 (Rumelhart 1986).
struct BackPropagation {
  double rate = 0.02;     ///< large: faster, but diverges beyond about 2 / (hidden nodes)
  double momentum = 0.9;  ///< fraction of the last step that is added
};
/// Adaptive learning rate for each weight (Kingma and Ba 2015).
struct Adam {
  double rate = 0.003;
  double decay1 = 0.9, decay2 = 0.999;  ///< of the mean gradient and of its mean square
};
using Trainer = std::variant<BackPropagation, Adam>;

struct TrainingOptions {
  Trainer trainer = BackPropagation{};
  int epochs = 300;           ///< full-batch steps; for BPNN-PSO 3000 predict no better than 200
  double target_error = 0.0;  ///< ends when the rms error of the scaled outputs is not above it
};

struct Training {
  Mlp net;
  std::vector<double> error;  ///< rms error of the scaled outputs before each epoch, and at the end
};

/// Trains on pairs of columns: inputs x n, outputs x n. Deterministic.
Training train(Mlp net, ConstMatrixRef inputs, ConstMatrixRef targets, const TrainingOptions& options = {});

/// Half the mean squared error per pair, and its gradient by all weights in the order of the members. Public for its
/// test against finite differences.
struct LossAndGradient {
  double loss = 0.0;
  VectorXd gradient;
};
LossAndGradient loss_and_gradient(const Mlp& net, ConstMatrixRef inputs, ConstMatrixRef targets);
VectorXd weights_of(const Mlp& net);
Mlp with_weights(Mlp net, ConstVectorRef weights);

/// Paper 2, section 3.2.1: n1 = √(m + n) + a, a = 1 .. 10. For 24 inputs and outputs 8 .. 17, not the 70 of figure 3.
int hidden_nodes_by_formula(Eigen::Index inputs, Eigen::Index outputs, int a);

/// "Step-by-step experiment": each number of nodes is trained on four fifths of the pairs and validated on the others.
struct NodeTrial {
  int nodes = 0;
  double training_error = 0.0, validation_error = 0.0;  ///< rms of the scaled outputs
};
std::vector<NodeTrial> compare_hidden_nodes(const Bounds& input_box, const Bounds& output_box, ConstMatrixRef inputs,
                                            ConstMatrixRef targets, const std::vector<int>& candidates,
                                            const TrainingOptions& options, int threads, Rng rng);

/// The network as text with all digits; parsing gives the same bits.
std::string format_mlp(const Mlp& net);
Result<Mlp> parse_mlp(std::string_view text, const std::string& name_in_messages);

}  // namespace kinfer
