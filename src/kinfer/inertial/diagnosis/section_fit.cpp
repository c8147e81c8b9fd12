// SPDX-License-Identifier: Apache-2.0
#include "kinfer/inertial/diagnosis/section_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr double grid_step = 0.01;            // [s] grid on which both instruments are compared
constexpr double longest_bridged_gap = 0.06;  // [s] beyond which samples are not interpolated
constexpr std::ptrdiff_t most_lag_steps = 15;
constexpr std::size_t lag_count = 2 * most_lag_steps + 1;
constexpr std::size_t section_steps = 200;                  // steps: 2 s
constexpr std::size_t section_margin = most_lag_steps + 2;  // steps before and after a section
constexpr std::size_t half_kernel = 5;                      // steps: triangular smoothing of both
constexpr std::size_t quiet_steps = 50;                     // steps of the quietest moment
constexpr double independent_samples = 20.0;  // samples of a section, since residuals are alike for tenths of a second
constexpr std::size_t most_sections = 120;
constexpr double usual_error = 0.01;  // of the direction's length: what scale errors and misalignments leave
constexpr int most_unknowns = 6;

using Samples = std::vector<Vec3>;
using Design = Eigen::Matrix<double, 3, most_unknowns>;

/// The triad at equally spaced times by linear interpolation; NaN in gaps.
Samples resampled(const TriadColumns& triad, std::span<const double> time, std::size_t steps) {
  Samples values(steps, Vec3::Constant(std::nan("")));
  std::size_t row = 0, before = 0;
  bool has_before = false;
  for (std::size_t k = 0; k < steps; ++k) {
    const double t = time.front() + grid_step * static_cast<double>(k);
    while (row < time.size() && (time[row] < t || !triad.at(row).allFinite())) {
      if (triad.at(row).allFinite()) before = row, has_before = true;
      ++row;
    }
    if (row >= time.size()) break;
    if (!has_before || time[row] - time[before] > longest_bridged_gap) continue;
    const double share = (t - time[before]) / (time[row] - time[before]);
    values[k] = (1.0 - share) * triad.at(before) + share * triad.at(row);
  }
  return values;
}

Samples smoothed_samples(const Samples& values) {
  constexpr double area = (half_kernel + 1) * (half_kernel + 1);
  Samples smooth(values.size(), Vec3::Constant(std::nan("")));
  for (std::size_t k = half_kernel; k + half_kernel < values.size(); ++k) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = k - half_kernel; i <= k + half_kernel; ++i)
      sum += static_cast<double>(half_kernel + 1 - (i > k ? i - k : k - i)) / area * values[i];
    smooth[k] = sum;
  }
  return smooth;
}

/// Mean rate of the quietest moment, or zero where even that moves.
Vec3 quietest_rate(const Samples& rate, double max_bias) {
  constexpr double quiet_share = 0.05;  // of the rms rate: the scatter of a moment at rest
  const double n = static_cast<double>(quiet_steps);
  Vec3 best = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity(), all = 0.0, moments = 0.0;
  for (std::size_t first = 0; first + quiet_steps <= rate.size(); first += quiet_steps) {
    Vec3 sum = Vec3::Zero();
    double square = 0.0;
    for (std::size_t k = first; k < first + quiet_steps; ++k) sum += rate[k], square += rate[k].squaredNorm();
    if (!std::isfinite(square)) continue;
    const Vec3 mean = sum / n;
    const double scatter = square / n - mean.squaredNorm();
    all += square / n, moments += 1.0;
    if (scatter < least && mean.norm() < max_bias) least = scatter, best = mean;
  }
  return least * moments < quiet_share * quiet_share * all ? best : Vec3(Vec3::Zero());
}

double median_length(const Samples& values) {
  std::vector<double> lengths;
  for (std::size_t k = 0; k < values.size(); k += 10)
    if (values[k].allFinite()) lengths.push_back(values[k].norm());
  return lengths.empty() ? 0.0 : median(std::move(lengths));
}

bool is_complete(const SectionSignals& signals, std::size_t first) {
  for (std::size_t k = first - section_margin; k < first + section_steps + section_margin; ++k)
    if (!signals.direction[k].allFinite() || !signals.rate[k].allFinite()) return false;
  return true;
}

/// Mean square of the direction's deviation from its mean, an axis, over so many steps.
double variance_over(const Samples& direction, std::size_t first, std::size_t steps) {
  Vec3 sum = Vec3::Zero();
  double square = 0.0;
  for (std::size_t k = first; k < first + steps; ++k) sum += direction[k], square += direction[k].squaredNorm();
  const double n = static_cast<double>(steps);
  return std::max(0.0, (square / n - (sum / n).squaredNorm()) / 3.0);
}

/// Variance at the quietest moment.
double quietest_variance(const Samples& direction) {
  constexpr double least = 1e-8;
  double quietest = std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first + quiet_steps <= direction.size(); first += quiet_steps)
    if (const double v = variance_over(direction, first, quiet_steps); std::isfinite(v))
      quietest = std::min(quietest, v);
  return std::isfinite(quietest) ? std::max(quietest, least) : least;
}

/// First steps of the sections without gaps.
std::vector<std::size_t> complete_sections(const SectionSignals& signals) {
  std::vector<std::size_t> sections;
  const std::size_t steps = signals.rate.size();
  const std::size_t stride = section_steps * (1 + steps / (section_steps * most_sections));
  for (std::size_t first = section_margin; first + section_steps + section_margin < steps; first += stride)
    if (is_complete(signals, first)) sections.push_back(first);
  return sections;
}

/// Those in which the direction moves by more than errors of this variance.
std::vector<std::size_t> moving_sections(const SectionSignals& signals, double error_variance) {
  constexpr double least_ratio = 4.0;  // of variances
  auto sections = complete_sections(signals);
  std::erase_if(sections, [&](std::size_t first) {
    return variance_over(signals.direction, first, section_steps) <= least_ratio * error_variance;
  });
  return sections;
}

double square_rate_over(const SectionSignals& signals, std::size_t first) {
  double sum = 0.0;
  for (std::size_t k = first; k < first + section_steps; ++k) sum += signals.rate[k].squaredNorm();
  return sum;
}

/// ∂f/∂(g, r) at a sample of the rates.
Design design_at(const Samples& rate, std::size_t k, const Mat3& map, const Mat3& begin_R_now) {
  const Mat3 w = skew(map * rate[k]);
  const Vec3 acceleration = map * (rate[k + 1] - rate[k - 1]) / (2.0 * grid_step);
  Design design;
  design << begin_R_now.transpose(), skew(acceleration) + w * w;
  return design;
}

/// Sums over a section that give the residual of every permutation of the direction's axes.
struct SectionSums {
  Eigen::Matrix<double, most_unknowns, most_unknowns> normal =
      Eigen::Matrix<double, most_unknowns, most_unknowns>::Zero();
  std::array<Eigen::Matrix<double, most_unknowns, 3>, 3> moments{};  // [k](i, j): sum of design(j, i) · direction(k)
  double square = 0.0;
  double count = 0.0;
};

SectionSums sums_over(const SectionSignals& signals, std::size_t first, const Mat3& map, std::ptrdiff_t shift) {
  SectionSums sums;
  for (auto& m : sums.moments) m.setZero();
  Mat3 rotation = Mat3::Identity();
  for (std::size_t i = 0; i < section_steps; i += 2) {
    const auto k = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(first + i) - shift);
    const Design design = design_at(signals.rate, k, map, rotation);
    const Vec3& f = signals.direction[first + i];
    sums.normal.noalias() += design.transpose() * design;
    for (int axis = 0; axis < 3; ++axis) sums.moments[static_cast<std::size_t>(axis)] += f[axis] * design.transpose();
    sums.square += f.squaredNorm();
    sums.count += 3.0;
    rotation = rotation * exp_so3(grid_step * (map * (signals.rate[k] + signals.rate[k + 1])));
  }
  return sums;
}

constexpr double lever_arm_weight = 0.01;  // lever arms of metres, no more

/// The inverse of the normal matrix of the first `unknowns`.
MatrixXd inverse_of(const SectionSums& sums, int unknowns, double weight = lever_arm_weight) {
  MatrixXd normal = sums.normal.topLeftCorner(unknowns, unknowns);
  for (int i = 3; i < unknowns; ++i) normal(i, i) += weight;
  return invert_spd(normal).value_or(MatrixXd::Zero(unknowns, unknowns));
}

/// Mean square of the residuals where `axes` leads from the design's axes to the direction's.
double residual_variance(const SectionSums& sums, const MatrixXd& inverse, const Mat3& axes) {
  Eigen::Matrix<double, most_unknowns, 1> right = Eigen::Matrix<double, most_unknowns, 1>::Zero();
  for (int k = 0; k < 3; ++k) right += sums.moments[static_cast<std::size_t>(k)] * axes.row(k).transpose();
  const auto used = right.head(inverse.rows());
  return std::max(sums.square - used.dot(inverse * used), 0.0) / sums.count;
}

/// Of residuals with this mean square, which errors of `error_variance` would leave in any case.
double log_likelihood(double variance, double error_variance) {
  return -0.5 * independent_samples * std::log(variance + error_variance);
}

/// Largest value at a local maximum other than the largest one and the one of no lag; minus infinity without any.
double rival_maximum(std::span<const double> of, std::size_t best, std::size_t none) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t s = 1; s + 1 < of.size(); ++s)
    if (s != best && s != none && of[s] >= of[s - 1] && of[s] >= of[s + 1]) most = std::max(most, of[s]);
  return most;
}

}  // namespace

const std::vector<Mat3>& signed_permutations() {
  static const std::vector<Mat3> all = [] {
    std::vector<Mat3> list;
    std::array<int, 3> order{0, 1, 2};
    do {
      for (unsigned signs = 0; signs < 8; ++signs) {
        Mat3 m = Mat3::Zero();
        for (int i = 0; i < 3; ++i) m(i, order[static_cast<std::size_t>(i)]) = (signs >> i) & 1U ? -1.0 : 1.0;
        list.push_back(m);
      }
    } while (std::ranges::next_permutation(order).found);
    return list;
  }();
  return all;
}

std::optional<SectionSignals> section_signals(const TriadColumns& direction, const TriadColumns& rates,
                                              std::span<const double> time, double max_bias) {
  constexpr double most_steps = 1e6;
  if (!direction.present() || !rates.present() || time.size() < 2) return std::nullopt;
  const auto steps = static_cast<std::size_t>(std::min((time.back() - time.front()) / grid_step, most_steps));
  if (steps < section_steps + 2 * section_margin) return std::nullopt;
  SectionSignals signals{smoothed_samples(resampled(direction, time, steps)),
                         smoothed_samples(resampled(rates, time, steps)), 0.0, 0.0};
  const Vec3 bias = quietest_rate(signals.rate, max_bias);
  for (Vec3& w : signals.rate) w -= bias;
  const double error = usual_error * median_length(signals.direction);
  signals.noise_variance = std::max(error * error, 1e-12);
  signals.quiet_variance = quietest_variance(signals.direction);
  return signals;
}

std::vector<std::size_t> telling_sections(const SectionSignals& signals) {
  constexpr double least_rate = 0.3;  // of that of the section in which the sensor rotates most
  auto sections = complete_sections(signals);
  double most = 0.0;
  for (const std::size_t first : sections) most = std::max(most, square_rate_over(signals, first));
  std::erase_if(sections, [&](std::size_t first) {
    return variance_over(signals.direction, first, section_steps) <= 4.0 * signals.noise_variance &&
           square_rate_over(signals, first) <= least_rate * least_rate * most;
  });
  return sections;
}

MapLikelihoods map_likelihoods(const SectionSignals& signals, std::span<const std::size_t> sections, double unit,
                               LeverArm lever_arm) {
  MapLikelihoods likelihoods;
  const auto& maps = signed_permutations();
  for (const std::size_t first : sections) {
    likelihoods.sections += 1.0;
    for (const double sense : {1.0, -1.0}) {
      const SectionSums sums = sums_over(signals, first, sense * unit * Mat3::Identity(), 0);
      const MatrixXd inverse = inverse_of(sums, lever_arm == LeverArm::free ? most_unknowns : 3);
      for (std::size_t m = 0; m < maps.size(); ++m)
        if (sense * maps[m].determinant() > 0.0)
          likelihoods.of[m] +=
              log_likelihood(residual_variance(sums, inverse, sense * maps[m]), signals.noise_variance);
    }
  }
  return likelihoods;
}

double factor_likelihood(const SectionSignals& signals, double factor) {
  const double weight = lever_arm_weight * std::pow(factor, 4.0);  // of lever arms in the time that they have then
  double sum = 0.0;
  for (const std::size_t first : telling_sections(signals)) {
    const SectionSums sums = sums_over(signals, first, factor * Mat3::Identity(), 0);
    sum += log_likelihood(residual_variance(sums, inverse_of(sums, most_unknowns, weight), Mat3::Identity()),
                          signals.noise_variance);
  }
  return sum;
}

InstrumentLag instrument_lag(const SectionSignals& signals, const Mat3& map) {
  // The free g takes up what scale errors and misalignments do to the direction's mean: they act on its change alone.
  // So a sensor that hardly tilts has a lag by its lever arm.
  constexpr double change_error = 0.03, quiet_ratio = 4.0;
  using Likelihood = std::array<double, lag_count>;
  std::array<Likelihood, 2> halves{};
  const auto sections = moving_sections(signals, quiet_ratio * signals.quiet_variance);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const double error_variance =
        quiet_ratio * signals.quiet_variance +
        change_error * change_error * variance_over(signals.direction, sections[i], section_steps);
    for (std::size_t s = 0; s < lag_count; ++s) {
      const SectionSums sums = sums_over(signals, sections[i], map, static_cast<std::ptrdiff_t>(s) - most_lag_steps);
      halves[2 * i / sections.size()][s] +=
          log_likelihood(residual_variance(sums, inverse_of(sums, most_unknowns), Mat3::Identity()), error_variance);
    }
  }
  Likelihood whole{};
  for (std::size_t s = 0; s < lag_count; ++s) whole[s] = halves[0][s] + halves[1][s];
  const auto best = static_cast<std::size_t>(std::ranges::max_element(whole) - whole.begin());
  const auto gain = [&](const Likelihood& l) { return l[best] - l[most_lag_steps]; };
  InstrumentLag result{grid_step * static_cast<double>(static_cast<std::ptrdiff_t>(best) - most_lag_steps), gain(whole),
                       rival_maximum(whole, best, most_lag_steps) - whole[most_lag_steps],
                       std::min(gain(halves[0]), gain(halves[1])), 0.0};
  if (best == 0 || best + 1 == lag_count) return result;
  const double before = whole[best - 1], after = whole[best + 1], curvature = 2.0 * whole[best] - before - after;
  if (!(curvature > 0.0)) return result;
  result.lag += 0.5 * grid_step * (after - before) / curvature;
  result.sd = grid_step / std::sqrt(curvature);
  return result;
}

}  // namespace kinfer
