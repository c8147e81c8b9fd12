// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/dh_leaf.hpp"

#include <cmath>
#include <numbers>

namespace kinfer::identify {
namespace {

constexpr double min_step = 1e-4, max_step = 0.3;  // [rad] or [m], scale of a shift
constexpr double max_share = 0.7;                  // of a mutated leaf's parameters; at least a tenth of it
constexpr double zero_share = 0.3;                 // of that for parameters that are 0: many shall stay 0

double angle_value(double value, int signal, std::span<const double> signals) {
  return signal == DhLeaf::constant ? value : value + signals[static_cast<std::size_t>(signal)];
}

}  // namespace

double theta_of(const DhLeaf& leaf, std::span<const double> signals) {
  return angle_value(leaf.theta, leaf.theta_signal, signals);
}

double alpha_of(const DhLeaf& leaf, std::span<const double> signals) {
  return angle_value(leaf.alpha, leaf.alpha_signal, signals);
}

Pose transform(const DhLeaf& leaf, std::span<const double> signals) {
  const double theta = theta_of(leaf, signals);
  return {rot_z(theta) * rot_x(alpha_of(leaf, signals)), {leaf.a * std::cos(theta), leaf.a * std::sin(theta), leaf.d}};
}

Pose transform(std::span<const DhLeaf> leaves, std::span<const double> signals) {
  Pose pose;
  for (const DhLeaf& leaf : leaves) pose = pose * transform(leaf, signals);
  return pose;
}

int count_signal_uses(std::span<const DhLeaf> leaves) {
  int uses = 0;
  for (const DhLeaf& leaf : leaves)
    uses += static_cast<int>(leaf.theta_signal != DhLeaf::constant) +
            static_cast<int>(leaf.alpha_signal != DhLeaf::constant);
  return uses;
}

double DhLeafOperators::draw_angle(Rng& rng) const {
  if (rng.uniform() < options_.zero_probability) return 0.0;
  if (rng.uniform() < options_.right_angle_probability)
    return 0.5 * std::numbers::pi * (static_cast<double>(rng.index(4)) - 1.0);
  return rng.uniform(-std::numbers::pi, std::numbers::pi);
}

double DhLeafOperators::draw_length(Rng& rng) const {
  return rng.uniform() < options_.zero_probability ? 0.0 : rng.uniform(-options_.max_length, options_.max_length);
}

void DhLeafOperators::draw_signal_or_angle(int& signal, double& angle, double signal_probability, Rng& rng) const {
  const bool is_variable = options_.signals > 0 && rng.uniform() < signal_probability;
  signal = is_variable ? static_cast<int>(rng.index(static_cast<std::uint64_t>(options_.signals))) : DhLeaf::constant;
  angle = has_free_constant(signal) ? draw_angle(rng) : 0.0;
}

void DhLeafOperators::draw_theta(DhLeaf& leaf, Rng& rng) const {
  draw_signal_or_angle(leaf.theta_signal, leaf.theta, options_.signal_probability, rng);
}

void DhLeafOperators::draw_alpha(DhLeaf& leaf, Rng& rng) const {
  draw_signal_or_angle(leaf.alpha_signal, leaf.alpha, options_.signal_probability / 3.0, rng);
}

DhLeaf DhLeafOperators::random(Rng& rng) const {
  DhLeaf leaf;
  draw_theta(leaf, rng);
  draw_alpha(leaf, rng);
  leaf.d = draw_length(rng);
  leaf.a = draw_length(rng);
  return leaf;
}

void DhLeafOperators::vary(std::span<DhLeaf> leaves, Rng& rng) const {
  if (leaves.size() > 1 && rng.uniform() < options_.opposite_shift_probability) return shift_between(leaves, rng);
  const double share = max_share * std::pow(0.1, rng.uniform());
  for (DhLeaf& leaf : leaves) mutate_parameters(leaf, share, rng);
}

void DhLeafOperators::mutate_parameters(DhLeaf& leaf, double share, Rng& rng) const {
  const auto is_redrawn = [&] { return rng.uniform() < options_.redraw_probability * share; };
  const auto shift = [&](double& number) {
    if (rng.uniform() < (number == 0.0 ? zero_share : 1.0) * share) number += draw_step(rng);
  };
  if (is_redrawn())
    draw_theta(leaf, rng);
  else if (has_free_constant(leaf.theta_signal))
    shift(leaf.theta);
  if (is_redrawn())
    draw_alpha(leaf, rng);
  else if (has_free_constant(leaf.alpha_signal))
    shift(leaf.alpha);
  if (is_redrawn())
    leaf.d = draw_length(rng);
  else
    shift(leaf.d);
  if (is_redrawn())
    leaf.a = draw_length(rng);
  else
    shift(leaf.a);
}

void DhLeafOperators::shift_between(std::span<DhLeaf> leaves, Rng& rng) const {
  const auto draw_length = [&] {
    DhLeaf& leaf = leaves[rng.index(leaves.size())];
    return rng.index(2) == 0 ? &leaf.d : &leaf.a;
  };
  const auto draw_angle = [&]() -> double* {
    DhLeaf& leaf = leaves[rng.index(leaves.size())];
    const bool is_theta = rng.index(3) > 0;
    if (!has_free_constant(is_theta ? leaf.theta_signal : leaf.alpha_signal)) return nullptr;
    return is_theta ? &leaf.theta : &leaf.alpha;
  };
  const auto shift = [&](double* one, double* other, double ratio) {
    const double step = draw_step(rng);
    if (one) *one += step;
    if (other && other != one) *other += ratio * step;
  };
  const std::uint64_t kinds = 1 + rng.index(3);  // bit 0: lengths, bit 1: angles
  if ((kinds & 1) != 0) {
    double *one = draw_length(), *other = draw_length();
    const double ratio = std::pow(2.0, rng.uniform(-1.0, 1.0));
    shift(one, other, rng.index(4) == 0 ? ratio : -ratio);
  }
  if ((kinds & 2) != 0) {  // orientations are known far better than positions: the rotations must cancel
    double *one = draw_angle(), *other = draw_angle();
    shift(one, other, rng.index(4) == 0 ? 1.0 : -1.0);
  }
}

double DhLeafOperators::draw_step(Rng& rng) const {
  const double size = min_step * std::pow(max_step / min_step, rng.uniform());
  return size * rng.normal();
}

}  // namespace kinfer::identify
