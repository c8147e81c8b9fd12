// The building block of paper 1's trees: one DH transformation whose angles may be terminals (paper 1, eq. 1 and fig.
// 4).
#pragma once

#include <span>
#include <vector>

#include "kinfer/base/rng.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/search/product_tree.hpp"

namespace kinfer {

/// TransZ(d) RotZ(theta) TransX(a) RotX(alpha).
struct DhLeaf {
  static constexpr int constant = -1;
  double theta = 0.0, d = 0.0, alpha = 0.0, a = 0.0;  ///< [rad], [m]
  int theta_signal = constant,
      alpha_signal = constant;  ///< index of the signal that is added to the angle, or `constant`
};

/// What an angle may be that is a signal.
enum class SignalAngles {
  plain,  ///< the signal, as in paper 1
  offset  ///< the signal and a constant: for signals whose zero is arbitrary
};

using DhTree = ProductTree<DhLeaf>;

/// Angles of the leaf when the signals have these values [rad].
double theta_of(const DhLeaf& leaf, std::span<const double> signals);
double alpha_of(const DhLeaf& leaf, std::span<const double> signals);

/// The leaf's transformation, and the product of several, front to back.
Pose transform(const DhLeaf& leaf, std::span<const double> signals = {});
Pose transform(std::span<const DhLeaf> leaves, std::span<const double> signals = {});

/// How often a signal stands in the leaves.
int signal_uses(std::span<const DhLeaf> leaves);

/// How random leaves are drawn and varied; each number is a prior of the search, not of the result.
struct DhLeafOptions {
  int signals = 1;  ///< terminals on offer
  SignalAngles signal_angles = SignalAngles::plain;
  double longest = 3.0;                  ///< [m] of new lengths; varied ones may leave it
  double variable_probability = 0.35;    ///< of a new angle theta being a signal; alpha a third of it
  double zero_probability = 0.5;         ///< of a new number being 0: most DH numbers of machines are
  double square_probability = 0.4;       ///< of a new angle that is not 0 being a multiple of 90°
  double renew_probability = 0.1;        ///< of a number that is to change being drawn anew; else it is shifted
  double compensated_probability = 0.4;  ///< of shifting two numbers against each other: a joint moved within its link
};

/// Draws and varies leaves, as TreeBreed wants it.
class DhLeaves {
 public:
  explicit DhLeaves(const DhLeafOptions& options) : options_(options) {}
  DhLeaf random(Rng& rng) const;

  /// Changes numbers of a sub-tree. Either some of them are shifted, by normal steps whose sizes are drawn too, from a
  /// ten-thousandth to a few tenths of a rad or m, or drawn anew; or two of a kind are shifted against each other,
  /// which follows the long valley of chains that differ in where the joint sits between the sensors.
  void vary(std::span<DhLeaf> leaves, Rng& rng) const;

 private:
  void draw_theta(DhLeaf& leaf, Rng& rng) const;
  void draw_alpha(DhLeaf& leaf, Rng& rng) const;
  void draw_signal_or_angle(int& signal, double& angle, double variable_probability, Rng& rng) const;
  bool may_change(int signal) const {
    return signal == DhLeaf::constant || options_.signal_angles == SignalAngles::offset;
  }
  double draw_angle(Rng& rng) const;
  double draw_length(Rng& rng) const;
  double draw_step(Rng& rng) const;
  void vary_numbers(DhLeaf& leaf, double share, Rng& rng) const;
  void shift_between(std::span<DhLeaf> leaves, Rng& rng) const;
  DhLeafOptions options_;
};

using DhBreed = TreeBreed<DhLeaf, DhLeaves>;

}  // namespace kinfer
