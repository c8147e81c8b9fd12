// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/initial_turns.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

/// What is known of a fault: its size ~ N(mean, covariance), from scores that count less by `excess`.
struct FaultBelief {
  Vec3 mean = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
  double excess = 1.0;
  double log_odds = 0.0;  ///< against what is usual
  double explains = 0.0;  ///< ln odds against no fault, with scores that count in full
};

/// ln of the integral of the likelihood over N(0, sd²), against the size 0.
double log_evidence(const FaultScore& sum, const Vec3& sd) {
  const Mat3 m = Mat3::Identity() + Mat3(sd.cwiseAbs2().asDiagonal()) * sum.information;
  return 0.5 * sum.score.dot(m.inverse() * sd.cwiseAbs2().cwiseProduct(sum.score)) - 0.5 * std::log(m.determinant());
}

/// The largest of the eigenvalues of a matrix that has no negative ones: λ = (tr m¹⁶)^(1/16), by 7 % at most too large.
double largest_eigenvalue(Mat3 m) {
  const double trace = m.trace();
  if (!(trace > 0.0)) return 0.0;
  m /= trace;
  for (int i = 0; i < 4; ++i) m = Mat3(m * m);
  return trace * std::pow(m.trace(), 1.0 / 16.0);
}

/// As long as what the chain does not explain lasts, where there are enough of them.
std::size_t stretches_in_cluster(const ConstantFaults& faults) {
  const auto lasting = static_cast<std::size_t>(std::lround(fault_correlation / faults.stretch_length()));
  return std::max<std::size_t>(1, std::min(lasting, faults.stretches() / least_fault_stretches));
}

/// By how much scores scatter from stretch to stretch, over what they should.
double excess_scatter(const ConstantFaults& faults, std::size_t fault, const Vec3& mean, const Mat3& information) {
  Mat3 scatter = Mat3::Zero();
  const std::size_t size = stretches_in_cluster(faults);
  Vec3 r = Vec3::Zero();
  for (std::size_t k = 0; k < faults.stretches(); ++k) {
    const FaultScore& stretch = faults.of(fault, k);
    r += stretch.score - stretch.information * mean;
    if ((k + 1) % size != 0 && k + 1 != faults.stretches()) continue;
    scatter += r * r.transpose();
    r.setZero();
  }
  return std::max(1.0, largest_eigenvalue(information.inverse() * scatter));
}

FaultBelief belief(const ConstantFaults& faults, std::size_t fault, double usual_sd, double sd) {
  FaultScore sum = faults.of(fault);
  const Mat3 known = Mat3::Identity() / square(sd);
  FaultBelief result;
  result.mean = (sum.information + known).inverse() * sum.score;
  result.excess = excess_scatter(faults, fault, result.mean, sum.information + known);
  Vec3 wide = Vec3::Zero(), usual = Vec3::Zero();
  const Index n = ConstantFaults::unknowns(fault, faults.size());
  wide.head(n).setConstant(sd), usual.head(n).setConstant(usual_sd);
  result.explains = log_evidence(sum, wide);
  sum.score /= result.excess, sum.information /= result.excess;
  result.covariance = (sum.information + known).inverse();
  result.mean = result.covariance * sum.score;
  result.log_odds = log_evidence(sum, wide) - log_evidence(sum, usual);
  return result;
}

/// [rad] that a turn usually seems to be: what the identification left unexplained, as a direction of gravity, and
/// where gravity keeps its direction in the sensor's frame the bias of its accelerometer, which shows as the same; of
/// the base's sensor what axes on the base may be off.
double usual_turn(const ChainFilter& filter, std::size_t sensor) {
  const FilterModel& model = filter.model();
  const double scatter = filter.constant_faults().force_scatter(sensor),
               by_bias = model.bias.force / (1.0 + square(scatter / bias_is_told)),
               by_axes = model.sensors[sensor].body == 0 ? model.cone_sd : 0.0;
  return std::hypot(least_usual_turn, by_axes,
                    std::hypot(model.sensors[sensor].persistent.force, by_bias) / model.gravity);
}

FaultBelief belief_in(std::size_t fault, const ChainFilter& filter) {
  const ConstantFaults& faults = filter.constant_faults();
  if (fault < faults.delay()) return belief(faults, fault, usual_turn(filter, fault), turned_mount_sd);
  return fault == faults.delay() ? belief(faults, fault, usual_delay, delay_sd)
                                 : belief(faults, fault, usual_scale, scale_sd);
}

}  // namespace

bool InitialTurn::tells_sensor() const {
  return log_odds_of_sensor > initial_turn_log_odds;
}

std::optional<InitialTurn> initial_turn(const ChainFilter& filter) {
  const ConstantFaults& faults = filter.constant_faults();
  if (faults.stretches() < least_fault_stretches) return {};
  FaultBelief best;
  std::size_t likeliest = faults.size();
  double next = 0.0;
  for (std::size_t f = 0; f < faults.size(); ++f) {
    const FaultBelief other = belief_in(f, filter);
    next = std::max(next, std::min(best.explains, other.explains));
    if (other.explains > best.explains) best = other, likeliest = f;
  }
  if (likeliest >= faults.delay() || best.mean.norm() > most_initial_turn) return {};
  if (best.log_odds < initial_turn_log_odds) return {};
  return InitialTurn{.sensor = likeliest,
                     .turn = {best.mean, best.covariance},
                     .excess = best.excess,
                     .log_odds = best.log_odds,
                     .log_odds_of_sensor = (best.explains - next) / best.excess};
}

}  // namespace kinfer::track
