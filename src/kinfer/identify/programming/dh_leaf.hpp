// SPDX-License-Identifier: Apache-2.0
// The leaf of paper 1's trees: one DH transformation whose angles may contain joint-variable candidates (paper 1, eq. 1
// and fig. 4).
#pragma once

#include <span>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/search/evolution/product_tree.hpp"

namespace kinfer::identify {

/// TransZ(d) RotZ(theta) TransX(a) RotX(alpha).
struct DhLeaf {
  static constexpr int constant = -1;
  double theta = 0.0, d = 0.0, alpha = 0.0, a = 0.0;  ///< [rad], [m]
  int theta_signal = constant,
      alpha_signal = constant;  ///< index of the signal that is added to the angle, or `constant`
};

/// Form of an angle that contains a joint signal.
enum class SignalAngleForm {
  plain,  ///< the signal alone, as in paper 1
  offset  ///< the signal plus a constant: for signals whose zero is arbitrary
};

using DhTree = ProductTree<DhLeaf>;

/// Angles of the leaf at these signal values [rad].
double theta_of(const DhLeaf& leaf, std::span<const double> signals);
double alpha_of(const DhLeaf& leaf, std::span<const double> signals);

/// The leaf's transformation, and the product of several, first to last.
Pose transform(const DhLeaf& leaf, std::span<const double> signals = {});
Pose transform(std::span<const DhLeaf> leaves, std::span<const double> signals = {});

/// Number of angles in the leaves that contain a signal.
int count_signal_uses(std::span<const DhLeaf> leaves);

/// How random leaves are drawn and mutated; each value is a prior of the search, not of the result.
struct DhLeafOptions {
  int signals = 1;  ///< number of joint-variable candidates
  SignalAngleForm signal_angle_form = SignalAngleForm::plain;
  double max_length = 3.0;                  ///< [m] limit of newly drawn lengths; mutation may exceed it
  double signal_probability = 0.35;         ///< that a new theta contains a signal; alpha: a third of it
  double zero_probability = 0.5;            ///< that a new parameter is 0: most DH parameters of machines are
  double right_angle_probability = 0.4;     ///< that a new non-zero angle is a multiple of 90°
  double redraw_probability = 0.1;          ///< that a parameter to be changed is redrawn; otherwise it is shifted
  double opposite_shift_probability = 0.4;  ///< of opposite shifts of two parameters: moves a joint within its link
};

/// Draws and mutates leaves: the leaf operators of TreeOperators.
class DhLeafOperators {
 public:
  explicit DhLeafOperators(const DhLeafOptions& options) : options_(options) {}
  DhLeaf random(Rng& rng) const;

  /// Mutates the parameters of a sub-tree. Either some of them are redrawn or shifted by normal steps whose scale is
  /// drawn, too, from a ten-thousandth to a few tenths of a rad or m; or two of a kind are shifted in opposite
  /// directions, which follows the long valley of chains that differ in where the joint lies between the sensors.
  void vary(std::span<DhLeaf> leaves, Rng& rng) const;

 private:
  void draw_theta(DhLeaf& leaf, Rng& rng) const;
  void draw_alpha(DhLeaf& leaf, Rng& rng) const;
  void draw_signal_or_angle(int& signal, double& angle, double signal_probability, Rng& rng) const;
  bool has_free_constant(int signal) const {
    return signal == DhLeaf::constant || options_.signal_angle_form == SignalAngleForm::offset;
  }
  double draw_angle(Rng& rng) const;
  double draw_length(Rng& rng) const;
  double draw_step(Rng& rng) const;
  void mutate_parameters(DhLeaf& leaf, double share, Rng& rng) const;
  void shift_between(std::span<DhLeaf> leaves, Rng& rng) const;
  DhLeafOptions options_;
};

using DhBreed = TreeOperators<DhLeaf, DhLeafOperators>;

}  // namespace kinfer::identify
