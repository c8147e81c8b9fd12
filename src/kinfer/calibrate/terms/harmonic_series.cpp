// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/harmonic_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/kinematics/poses/harmonic_sum.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

/// Knots of the spline over one revolution, and the highest order kept of it: all but 0.4 % of its amplitude.
struct Resolution {
  int knots = 0, order = 0;
};
constexpr std::array<Resolution, 3> resolutions{{{32, 24}, {63, 47}, {126, 94}}};

bool is_harmonic_field(Field field) {
  return field == Field::sine || field == Field::cosine;
}

int knots_for(int order) {
  for (const Resolution& r : resolutions)
    if (r.order == order) return r.knots;
  return 0;
}

/// The part of a harmonic that a cubic B-spline passes: the fourth power of sin(x) / x.
double passed(int order, int knots) {
  const double x = std::numbers::pi * order / knots;
  return order == 0 ? 1.0 : std::pow(std::sin(x) / x, 4.0);
}

/// Sines and cosines of 2π k / n.
struct Circle {
  std::vector<double> sine, cosine;

  explicit Circle(int n) {
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / n;
      sine.push_back(std::sin(angle)), cosine.push_back(std::cos(angle));
    }
  }
};

/// The harmonics of a spline with coefficients at knots 2π k / n.
std::vector<Harmonic> harmonics_of(const VectorXd& coefficients, int highest) {
  const auto knots = static_cast<int>(coefficients.size());
  const Circle circle(knots);
  std::vector<Harmonic> list;
  for (int order = 0; order <= highest; ++order) {
    Harmonic h{static_cast<double>(order)};
    for (int k = 0; k < knots; ++k) {
      const auto at = static_cast<std::size_t>(order * k % knots);
      h.sine += coefficients[k] * circle.sine[at], h.cosine += coefficients[k] * circle.cosine[at];
    }
    const double scale = (order == 0 ? 1.0 : 2.0) / knots * passed(order, knots);
    h.sine *= scale, h.cosine *= scale;
    list.push_back(h);
  }
  return list;
}

/// The coefficients of the spline that a series came from.
VectorXd coefficients_of(const Joint& joint, int knots) {
  const Circle circle(knots);
  VectorXd coefficients = VectorXd::Zero(knots);
  for (int order = 0; 2 * order <= knots; ++order) {
    const Harmonic& h = joint.harmonics[static_cast<std::size_t>(order)];
    const double scale = (2 * order == knots ? 0.5 : 1.0) / passed(order, knots);
    for (int k = 0; k < knots; ++k) {
      const auto at = static_cast<std::size_t>(order * k % knots);
      coefficients[k] += scale * (h.sine * circle.sine[at] + h.cosine * circle.cosine[at]);
    }
  }
  return coefficients;
}

/// The four knots that act at a joint position.
struct ActingKnots {
  std::array<int, 4> knot;
  std::array<double, 4> weight;
};

ActingKnots knots_at(double position, int knots) {
  const double along = position * knots / (2.0 * std::numbers::pi), below = std::floor(along), t = along - below,
               u = 1.0 - t;
  const auto first = static_cast<int>(std::fmod(below, knots)) - 1;
  ActingKnots acting{
      {}, {u * u * u / 6.0, 2.0 / 3.0 - t * t + 0.5 * t * t * t, 2.0 / 3.0 - u * u + 0.5 * u * u * u, t * t * t / 6.0}};
  for (int k = 0; k < 4; ++k) acting.knot[k] = ((first + k) % knots + knots) % knots;
  return acting;
}

/// The series of one joint.
struct JointSeries {
  int joint = 0;
  Resolution resolution;
  VectorXd coefficients;  // of all knots
};

/// A chain without the entries of its series; parameters of other harmonics refer to it.
struct DetachedSeries {
  Chain plain;
  ParameterSet set;
  std::vector<JointSeries> series;
};

DetachedSeries detach(const Chain& chain, const ParameterSet& set) {
  DetachedSeries apart{chain, set, {}};
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    const int order = series_order(chain.joints[j]);
    if (order == 0) continue;
    const Resolution resolution{knots_for(order), order};
    apart.series.push_back({static_cast<int>(j), resolution, coefficients_of(chain.joints[j], resolution.knots)});
    std::vector<Harmonic>& harmonics = apart.plain.joints[j].harmonics;
    harmonics.erase(harmonics.begin(), harmonics.begin() + order + 1);
    for (Parameter& p : apart.set.parameters)
      if (auto* at = std::get_if<JointNumber>(&p.at);
          at && at->joint == static_cast<int>(j) && is_harmonic_field(at->field))
        at->term -= order + 1;
  }
  return apart;
}

Chain attach(Chain plain, const std::vector<JointSeries>& series) {
  for (const JointSeries& s : series) {
    const std::vector<Harmonic> list = harmonics_of(s.coefficients, s.resolution.order);
    std::vector<Harmonic>& harmonics = plain.joints[s.joint].harmonics;
    harmonics.insert(harmonics.begin(), list.begin(), list.end());
  }
  return plain;
}

/// The joints moved by their series, which a chain without them then need not have: what other terms make of the small
/// difference is below a tenth of a micrometre.
PoseSet with_moved_joints(PoseSet rows, const Chain& plain, const std::vector<JointSeries>& series) {
  const std::vector<int> q_index = active_joint_indices(plain);
  for (const JointSeries& s : series) {
    const HarmonicSum series(harmonics_of(s.coefficients, s.resolution.order));
    for (double& q : rows.joints.row(q_index[s.joint])) q += series.at(q);
  }
  return rows;
}

/// The unknown coefficients of one joint: those of the knots that act at some row.
struct SeriesBlock {
  int joint = 0, knots = 0;
  std::vector<Index> unknown;  // of each knot; -1: none
  Index begin = 0, count = 0;
};

std::vector<SeriesBlock> make_blocks(const Chain& plain, const std::vector<JointSeries>& series, const PoseSet& rows,
                                     Index behind) {
  const std::vector<int> q_index = active_joint_indices(plain);
  std::vector<SeriesBlock> blocks;
  for (const JointSeries& s : series) {
    const int knots = s.resolution.knots;
    SeriesBlock block{s.joint, knots, std::vector<Index>(static_cast<std::size_t>(knots), -1), behind};
    for (const double q : rows.joints.row(q_index[s.joint]))
      for (const int knot : knots_at(q, knots).knot) block.unknown[static_cast<std::size_t>(knot)] = 0;
    for (Index& unknown : block.unknown)
      if (unknown == 0) unknown = behind++;
    block.count = behind - block.begin;
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// Measurements to which series are fitted.
struct SeriesData {
  const PoseSet& rows;
  const Weights& weights;
  int threads = 1;
};

/// Residuals at a chain and their derivatives by its free parameters and by the variables of the joints with series.
struct Linearised {
  MatrixXd among_parameters;  // Jᵀ J
  MatrixXd by_parameter;      // J transposed: parameters x residuals
  MatrixXd by_joint;          // series x residuals
  VectorXd residuals;
  std::vector<int> pose;  // of each residual; -1: none
};

Linearised linearise(Chain chain, const ParameterSet& set, const SeriesData& data,
                     const std::vector<SeriesBlock>& blocks) {
  ParameterSet all{set.parameters, {}};
  for (const SeriesBlock& block : blocks) {  // the cosine of order 0 is 1: its column is that of the joint variable
    std::vector<Harmonic>& harmonics = chain.joints[block.joint].harmonics;
    harmonics.push_back({0.0});
    const int term = static_cast<int>(harmonics.size()) - 1;
    all.parameters.push_back(parameter_at(chain, JointNumber{block.joint, Field::cosine, term}, 1.0));
  }
  VectorXd r;
  MatrixXd jacobian;
  pose_residuals(chain, all, data.rows, data.weights, data.threads).evaluate(pack(all, chain), r, &jacobian);
  const Index parameters = set.free_count(), count = r.size() - all.free_count();
  Linearised at{gram(jacobian.topLeftCorner(count, parameters)), jacobian.topLeftCorner(count, parameters).transpose(),
                jacobian.topRows(count).rightCols(static_cast<Index>(blocks.size())).transpose(), r.head(count),
                std::vector<int>(static_cast<std::size_t>(count), -1)};
  std::size_t row = 0;  // behind the blocks follow socket distances, on which no joint acts
  for (const Block& block : blocks_of(data.rows))
    for (int k = 0; k < block.size; ++k) at.pose[row++] = block.row;
  return at;
}

/// Normal equations of the measurements, without priors, about the chain without its series.
struct SeriesSystem {
  std::vector<SeriesBlock> blocks;
  MatrixXd matrix;  // lower half
  VectorXd gradient;
  double squares = 0.0;
  Index residuals = 0;
};

/// Sums over some of the residuals.
struct SeriesSums {
  MatrixXd among_series;  // lower half
  MatrixXd across;        // parameters x series
  VectorXd gradient;
};

SeriesSums sums_of(const Linearised& at, const std::vector<SeriesBlock>& blocks, const MatrixXd& positions, Index first,
                   Index end) {
  const Index parameters = at.by_parameter.rows(), behind = blocks.back().begin + blocks.back().count - parameters;
  SeriesSums sums{MatrixXd::Zero(behind, behind), MatrixXd::Zero(parameters, behind), VectorXd::Zero(behind)};
  std::vector<std::pair<Index, double>> acting;  // coefficients and derivatives of one residual
  for (Index row = first; row < end; ++row) {
    const int pose = at.pose[static_cast<std::size_t>(row)];
    if (pose < 0) continue;
    acting.clear();
    for (std::size_t s = 0; s < blocks.size(); ++s) {
      const double slope = at.by_joint(static_cast<Index>(s), row);
      const ActingKnots knots = knots_at(positions(static_cast<Index>(s), pose), blocks[s].knots);
      for (int k = 0; k < 4; ++k)
        acting.emplace_back(blocks[s].unknown[static_cast<std::size_t>(knots.knot[k])] - parameters,
                            slope * knots.weight[k]);
    }
    for (const auto& [i, value] : acting) {
      sums.across.col(i) += value * at.by_parameter.col(row);
      sums.gradient[i] += value * at.residuals[row];
      for (const auto& [k, other] : acting)
        if (k <= i) sums.among_series(i, k) += value * other;
    }
  }
  return sums;
}

SeriesSystem make_system(const DetachedSeries& apart, const SeriesData& data) {
  constexpr Index residuals_a_part = 8192;  // whatever the threads, so that the sums are the same
  const auto& [plain, set, series] = apart;
  const Index p = set.free_count();
  SeriesSystem system{make_blocks(plain, series, data.rows, p), {}, {}};
  const Linearised at = linearise(plain, set, data, system.blocks);
  const Index unknowns = system.blocks.empty() ? p : system.blocks.back().begin + system.blocks.back().count;
  system.matrix = MatrixXd::Zero(unknowns, unknowns), system.gradient = VectorXd::Zero(unknowns);
  system.matrix.topLeftCorner(p, p) = at.among_parameters;
  system.gradient.head(p) = at.by_parameter * at.residuals;
  system.squares = at.residuals.squaredNorm(), system.residuals = at.residuals.size();
  if (system.blocks.empty()) return system;
  const std::vector<int> q_index = active_joint_indices(plain);
  MatrixXd positions(static_cast<Index>(system.blocks.size()), data.rows.rows());
  for (std::size_t s = 0; s < system.blocks.size(); ++s)
    positions.row(static_cast<Index>(s)) = data.rows.joints.row(q_index[system.blocks[s].joint]);
  std::vector<SeriesSums> sums(static_cast<std::size_t>(1 + system.residuals / residuals_a_part));
  parallel_for(sums.size(), data.threads, [&](std::size_t k) {
    const Index first = residuals_a_part * static_cast<Index>(k);
    sums[k] = sums_of(at, system.blocks, positions, first, std::min(first + residuals_a_part, system.residuals));
  });
  const Index n = unknowns - p;
  for (const SeriesSums& part : sums) {
    system.matrix.bottomRightCorner(n, n) += part.among_series;
    system.matrix.bottomLeftCorner(n, p) += part.across.transpose();
    system.gradient.tail(n) += part.gradient;
  }
  return system;
}

struct Solution {
  VectorXd step;        // of the parameters, and the coefficients
  MatrixXd covariance;  // of both
  double noise = 1.0;   // variance in units of the weights
};

class SeriesProblem {
 public:
  /// Starts with the sizes that the coefficients have.
  SeriesProblem(const DetachedSeries& apart, const SeriesData& data)
      : apart_(apart),
        system_(make_system(apart, data)),
        parameters_(apart.set.free_count()),
        prior_(MatrixXd::Zero(system_.gradient.size(), system_.gradient.size())),
        pull_(VectorXd::Zero(system_.gradient.size())),
        offset_(VectorXd::Zero(system_.gradient.size())) {
    const MatrixXd of_parameters = prior_information(apart.set);
    prior_.topLeftCorner(parameters_, parameters_) = of_parameters;
    offset_.head(parameters_) = pack(apart.set, apart.plain) - nominal_of(apart.set);
    pull_.head(parameters_) = of_parameters * offset_.head(parameters_);
    set_variances(present_variances());
  }

  Solution solve(double noise) const {
    const auto covariance = invert_spd(system_.matrix / noise + prior_);
    KINFER_EXPECT(covariance, "{} unknowns with priors have a covariance", system_.gradient.size());
    return {-(*covariance * (system_.gradient / noise + pull_)), *covariance, noise};
  }

  /// The noise level and the variances that maximise the marginal likelihood, from the present ones on.
  Solution maximise(int rounds) {
    Solution s = solve(1.0);
    for (int round = 0; round < rounds; ++round) {
      std::vector<double> variance = variance_;
      for (std::size_t k = 0; k < variance.size(); ++k) {
        const double squares = coefficients(s, k).squaredNorm();
        variance[k] =
            std::clamp(squares / std::max(effective_number(s, k), 1e-3), 1e-8 * largest_variance, largest_variance);
      }
      const double redundancy = static_cast<double>(system_.residuals) - effective_number(s);
      const double noise = residual_squares(s.step) / std::max(1.0, redundancy);
      set_variances(std::move(variance));
      s = solve(noise);
    }
    return s;
  }

  double log_evidence(const Solution& s) const {
    const auto root = cholesky(s.covariance);
    KINFER_EXPECT(root, "a covariance is positive definite");
    const VectorXd at = offset_ + s.step;
    double sum = residual_squares(s.step) / s.noise + at.dot(prior_ * at) +
                 static_cast<double>(system_.residuals) * std::log(s.noise) -
                 2.0 * root->diagonal().array().log().sum();
    for (std::size_t k = 0; k < variance_.size(); ++k)
      sum += static_cast<double>(system_.blocks[k].count) * std::log(variance_[k]);
    for (Index k = 0; k < parameters_; ++k)
      if (prior_(k, k) > 0.0) sum -= std::log(prior_(k, k));
    return -0.5 * sum;
  }

  /// Log Bayes factor of a series against none, for all sizes. At the best size it is the density of the coefficients
  /// at zero, after over before (Savage, Dickey); log size has a half-Cauchy prior with the size of other harmonics,
  /// and is known to 1 / √(2 effective number).
  double log_bayes_factor(const Solution& s, std::size_t series) const {
    const SeriesBlock& block = system_.blocks[series];
    const MatrixXd own = s.covariance.block(block.begin, block.begin, block.count, block.count);
    const VectorXd mean = coefficients(s, series);
    const auto root = cholesky(own);
    const auto weighted = solve_spd(own, mean);
    if (!root || !weighted) return 0.0;
    const double size = std::sqrt(variance_[series]) / thresholds::harmonic_prior;
    const double prior = std::log(2.0 / std::numbers::pi * size / (1.0 + size * size)),
                 width = 0.5 * std::log(std::numbers::pi / std::max(effective_number(s, series), 0.5));
    return 0.5 * mean.dot(*weighted) + root->diagonal().array().log().sum() -
           0.5 * static_cast<double>(block.count) * std::log(variance_[series]) + prior + width;
  }

  /// After a step.
  DetachedSeries moved_by(const VectorXd& step) const {
    DetachedSeries moved = apart_;
    moved.plain = unpack(apart_.set, apart_.plain, pack(apart_.set, apart_.plain) + step.head(parameters_));
    for (std::size_t k = 0; k < system_.blocks.size(); ++k) {
      const SeriesBlock& block = system_.blocks[k];
      for (int knot = 0; knot < block.knots; ++knot) {
        const Index unknown = block.unknown[static_cast<std::size_t>(knot)];
        moved.series[k].coefficients[knot] = unknown >= 0 ? step[unknown] : 0.0;
      }
    }
    return moved;
  }

  struct Step {
    VectorXd step;        // as in a solution
    MatrixXd covariance;  // of the parameters alone, the series being unknown
  };

  /// The solution at noise 1 by elimination of the series, whose own covariance takes a multiple of the time.
  Step step() const {
    const Index p = parameters_, n = prior_.cols() - p;
    const MatrixXd matrix = system_.matrix + prior_;
    const VectorXd gradient = system_.gradient + pull_;
    const auto root = cholesky(matrix.bottomRightCorner(n, n));
    KINFER_EXPECT(root, "{} coefficients with priors have a covariance", n);
    const auto lower = root->triangularView<Eigen::Lower>();
    const MatrixXd across = lower.solve(matrix.bottomLeftCorner(n, p));
    const VectorXd own = lower.solve(gradient.tail(n));
    const auto covariance = invert_spd(matrix.topLeftCorner(p, p) - across.transpose() * across);
    KINFER_EXPECT(covariance, "{} parameters with priors have a covariance", p);
    Step found{VectorXd(p + n), *covariance};
    found.step.head(p) = -(*covariance * (gradient.head(p) - across.transpose() * own));
    found.step.tail(n) = -lower.transpose().solve(own + across * found.step.head(p));
    return found;
  }

  /// [1] of the rms of the residuals by which a step lowers it.
  double relative_gain(const VectorXd& step) const {
    const double before = residual_squares(present()), after = residual_squares(step);
    return before > 0.0 ? 1.0 - std::sqrt(after / before) : 0.0;
  }

 private:
  static constexpr double first_variance = thresholds::first_series_size * thresholds::first_series_size,
                          largest_variance = thresholds::largest_series_size * thresholds::largest_series_size;

  /// Of the coefficients of each series.
  void set_variances(std::vector<double> variance) {
    variance_ = std::move(variance);
    for (std::size_t s = 0; s < variance_.size(); ++s)
      prior_.diagonal().segment(system_.blocks[s].begin, system_.blocks[s].count).setConstant(1.0 / variance_[s]);
  }

  /// Of the knots that rows reach.
  std::vector<double> present_variances() const {
    std::vector<double> variance;
    for (std::size_t k = 0; k < system_.blocks.size(); ++k) {
      const double squares = apart_.series[k].coefficients.squaredNorm();
      const double mean = squares / static_cast<double>(std::max<Index>(1, system_.blocks[k].count));
      variance.push_back(squares == 0.0 ? first_variance : std::clamp(mean, 1e-8 * largest_variance, largest_variance));
    }
    return variance;
  }

  VectorXd coefficients(const Solution& s, std::size_t series) const {
    return s.step.segment(system_.blocks[series].begin, system_.blocks[series].count);
  }
  /// The step that changes nothing: a step goes to coefficients, not by them.
  VectorXd present() const {
    VectorXd step = VectorXd::Zero(prior_.cols());
    for (std::size_t k = 0; k < system_.blocks.size(); ++k) {
      const SeriesBlock& block = system_.blocks[k];
      for (int knot = 0; knot < block.knots; ++knot)
        if (const Index unknown = block.unknown[static_cast<std::size_t>(knot)]; unknown >= 0)
          step[unknown] = apart_.series[k].coefficients[knot];
    }
    return step;
  }
  double residual_squares(const VectorXd& step) const {
    return system_.squares + 2.0 * system_.gradient.dot(step) +
           step.dot(system_.matrix.selfadjointView<Eigen::Lower>() * step);
  }
  /// Number of unknowns that the data determine.
  double effective_number(const Solution& s) const {
    return static_cast<double>(s.step.size()) - prior_.cwiseProduct(s.covariance).sum();
  }
  double effective_number(const Solution& s, std::size_t series) const {
    const SeriesBlock& block = system_.blocks[series];
    return static_cast<double>(block.count) -
           s.covariance.diagonal().segment(block.begin, block.count).sum() / variance_[series];
  }

  const DetachedSeries& apart_;
  SeriesSystem system_;
  Index parameters_;
  MatrixXd prior_;
  VectorXd pull_, offset_;
  std::vector<double> variance_;
};

/// Whether another joint follows this one: then it has no series, which would move that one too.
bool is_followed(const Chain& chain, std::size_t joint) {
  constexpr double followed = 0.05;  // [1] factor; what a coupling term finds is smaller
  return std::ranges::any_of(chain.joints, [&](const Joint& other) {
    return std::ranges::any_of(other.couplings, [&](const Coupling& c) {
      return c.joint == static_cast<int>(joint) && std::abs(c.factor) > followed;
    });
  });
}

/// Series of zeros for joints that turn far enough.
std::vector<JointSeries> zero_series(const Chain& chain, const PoseSet& rows, const Resolution& resolution) {
  const std::vector<int> q_index = active_joint_indices(chain);
  std::vector<JointSeries> series;
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    if (q_index[j] < 0 || !rotates(chain.joints[j].type) || is_followed(chain, j)) continue;
    const auto q = rows.joints.row(q_index[j]);
    if (q.maxCoeff() - q.minCoeff() >= thresholds::min_spectrum_range)
      series.push_back({static_cast<int>(j), resolution, VectorXd::Zero(resolution.knots)});
  }
  return series;
}

struct Candidate {
  DetachedSeries model;
  double log_evidence = 0.0;
  std::vector<double> bayes_factors;  // log, of each series
};

/// With the sizes and the noise level that maximise the marginal likelihood.
Candidate evaluate(const DetachedSeries& start, const SeriesData& data) {
  SeriesProblem problem(start, data);
  const Solution solution = problem.maximise(thresholds::series_rounds);
  Candidate candidate{problem.moved_by(solution.step), problem.log_evidence(solution), {}};
  for (std::size_t k = 0; k < start.series.size(); ++k)
    candidate.bayes_factors.push_back(problem.log_bayes_factor(solution, k));
  return candidate;
}

/// Drops series one by one, the one with the least odds first, until each has more than the prior odds of one among
/// all. None where none is left.
std::optional<Candidate> keep_supported(Candidate candidate, DetachedSeries plain, const SeriesData& data,
                                        double log_odds) {
  while (!candidate.bayes_factors.empty()) {
    const auto worst = std::ranges::min_element(candidate.bayes_factors);
    if (*worst > log_odds) return candidate;
    plain.series = candidate.model.series;
    plain.series.erase(plain.series.begin() + (worst - candidate.bayes_factors.begin()));
    candidate = evaluate(plain, data);
  }
  return std::nullopt;
}

ParameterSet without_harmonics(const ParameterSet& set) {
  ParameterSet kept;
  std::vector<Index> free;
  Index k = 0;
  for (const Parameter& p : set.parameters) {
    const JointNumber* at = joint_number(p.at);
    const bool is_harmonic = at && is_harmonic_field(at->field);
    if (!is_harmonic) kept.parameters.push_back(p);
    if (p.free && !is_harmonic) free.push_back(k);
    k += p.free;
  }
  // Harmonics are independent of all other parameters a priori.
  if (set.prior_sqrt_information.size() > 0) kept.prior_sqrt_information = set.prior_sqrt_information(free, free);
  return kept;
}

std::vector<bool> inliers_of(const Estimate& fitted, const PoseSet& rows) {
  std::vector<bool> is_inlier;
  for (const Block& block : blocks_of(rows))
    is_inlier.push_back(std::ranges::find(fitted.outliers, block.row, &Outlier::row) == fitted.outliers.end());
  return is_inlier;
}

}  // namespace

int series_order(const Joint& joint) {
  std::size_t count = 0;
  while (count < joint.harmonics.size() && joint.harmonics[count].order == static_cast<double>(count)) ++count;
  for (auto r = resolutions.rbegin(); r != resolutions.rend(); ++r)
    if (static_cast<int>(count) > r->order) return r->order;
  return 0;
}

bool has_series(const Chain& chain) {
  return std::ranges::any_of(chain.joints, [](const Joint& joint) { return series_order(joint) > 0; });
}

bool is_in_series(const Joint& joint, double order) {
  return order <= series_order(joint) && order == std::round(order) && series_order(joint) > 0;
}

Chain without_series(Chain chain) {
  for (Joint& joint : chain.joints)
    if (const int order = series_order(joint); order > 0)
      for (int k = 0; k <= order; ++k) joint.harmonics[static_cast<std::size_t>(k)] = {static_cast<double>(k)};
  return chain;
}

Chain with_series_of(Chain chain, const Chain& other) {
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    std::vector<Harmonic>& own = chain.joints[j].harmonics;
    const std::vector<Harmonic>& theirs = other.joints[j].harmonics;
    const int before = series_order(chain.joints[j]), after = series_order(other.joints[j]);
    if (before > 0) own.erase(own.begin(), own.begin() + before + 1);
    if (after > 0) own.insert(own.begin(), theirs.begin(), theirs.begin() + after + 1);
  }
  return chain;
}

std::optional<FoundSeries> find_series(const Estimate& fitted, const PoseSet& rows,
                                       const std::optional<Instrument>& instrument, int threads) {
  if (!rows.pairs.empty() || rows.rows() < static_cast<Index>(thresholds::min_spectrum_points)) return std::nullopt;
  const PoseSet kept = keep_measurements(rows, inliers_of(fitted, rows));
  const Weights weights = weights_of(kept, instrument, excess_noise(fitted.chain, kept, instrument, 0.0, threads));
  const SeriesData data{kept, weights, threads};
  const double without = evaluate({fitted.chain, fitted.parameters, {}}, data).log_evidence;
  DetachedSeries start{fitted.chain, without_harmonics(fitted.parameters), {}};
  for (Joint& joint : start.plain.joints) joint.harmonics.clear();  // those of gears are orders of the series
  std::optional<Candidate> best;
  for (const Resolution& resolution : resolutions) {
    start.series = zero_series(start.plain, kept, resolution);
    if (start.series.empty()) return std::nullopt;
    Candidate candidate = evaluate(start, data);
    if (best && candidate.log_evidence <= best->log_evidence) break;
    best = std::move(candidate);
  }
  const double log_odds = std::log(static_cast<double>(start.series.size() * resolutions.size()) + 1.0);
  best = keep_supported(*std::move(best), start, data, log_odds);
  if (!best) return std::nullopt;
  const double gain = best->log_evidence - without - log_odds;
  if (!(gain > 0.0)) return std::nullopt;
  return FoundSeries{attach(best->model.plain, best->model.series), start.set, gain};
}

Estimate fit_with_series(const Chain& start, const ParameterSet& set, const PoseSet& rows,
                         const std::optional<Instrument>& instrument, const BundleOptions& options,
                         const Observer& observer) {
  if (!has_series(start)) return fit_bundle(start, set, rows, instrument, options, observer);
  DetachedSeries model = detach(start, set);
  const auto fit_others = [&](Detail detail, InitialGuess guess, int iterations) {
    BundleOptions others = options;
    others.detail = detail, others.initial_guess = guess, others.max_iterations = iterations;
    return fit_bundle(model.plain, model.set, with_moved_joints(rows, model.plain, model.series), instrument, others,
                      observer);
  };
  const bool is_near = options.initial_guess == InitialGuess::near_optimum;  // only noise level and inliers are needed
  Estimate fit = fit_others(Detail::numbers_only, options.initial_guess, is_near ? 1 : options.max_iterations);
  model.plain = fit.chain;
  MatrixXd covariance = fit.covariance;
  for (int round = 0; round < thresholds::series_rounds; ++round) {
    const std::vector<bool> inliers = inliers_of(fit, rows);
    const PoseSet moved = keep_measurements(with_moved_joints(rows, model.plain, model.series), inliers);
    const Weights weights =
        weights_of(moved, instrument, excess_noise(model.plain, moved, instrument, 0.0, options.threads));
    const PoseSet kept = keep_measurements(rows, inliers);
    const SeriesProblem problem(model, {kept, weights, options.threads});
    const auto [step, of_parameters] = problem.step();
    const double gain = problem.relative_gain(step);
    covariance = of_parameters;
    model = problem.moved_by(step);
    if (is_near && gain <= thresholds::settled_noise)
      break;  // one linear step from the optimum of nearly the same rows
    const double before = fit.sigma;
    fit = fit_others(Detail::numbers_only, InitialGuess::near_optimum, options.max_iterations);
    model.plain = fit.chain;
    if (std::abs(fit.sigma - before) <= thresholds::settled_noise * before) break;
  }
  if (options.detail == Detail::all) {
    fit = fit_others(Detail::all, InitialGuess::near_optimum, options.max_iterations);
    model.plain = fit.chain;
  }
  fit.chain = attach(model.plain, model.series);
  fit.parameters = set;
  fit.covariance = covariance;
  const VectorXd values = pack(set, fit.chain);
  for (std::size_t k = 0; k < fit.values.size(); ++k) {
    const auto i = static_cast<Index>(k);
    fit.values[k].value = values[i];
    fit.values[k].sd = std::sqrt(std::max(0.0, covariance(i, i)));
  }
  return fit;
}

}  // namespace kinfer::calibrate
