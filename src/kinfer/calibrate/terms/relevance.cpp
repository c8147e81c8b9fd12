// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/relevance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::calibrate {
namespace {

constexpr int grid_points = 31;                                            // of factors
constexpr double smallest_factor = 1e-3, grid_ratio = 1.2589254117941673;  // 10 per decade, to 1
constexpr int most_sweeps = 20;                                            // usually three suffice
constexpr double settled_step = 0.5;                                       // [grid steps]
/// That a joint has a term that others have, below which it is left out. Chosen on MUKCa, FR3 and 60 simulated robots:
/// 0.02 is alike, 0.3 loses half of the gain.
constexpr double least_probability = 0.1;
constexpr double local_spread = 1.0;  // [log] sd of the sizes of one term's joints about their common size

double factor_at(int step) {
  return smallest_factor * std::pow(grid_ratio, step);
}

/// What the measurements say of one group given all others at one noise level, along the eigenvectors of its
/// information.
struct GroupAtNoise {
  VectorXd information, image;
  double log_probability = 0.0;  ///< of the noise level without the group

  /// log p(data | f) − log p(data | 0)
  double gain(double factor) const {
    const double v = factor * factor;
    double sum = 0.0;
    for (Eigen::Index k = 0; k < image.size(); ++k)
      sum += v * image[k] * image[k] / (1.0 + v * information[k]) - std::log1p(v * information[k]);
    return 0.5 * sum;
  }
};

/// The same over all noise levels.
struct ConditionalGroup {
  std::vector<GroupAtNoise> levels;

  double gain(double factor) const {
    std::vector<double> gains;
    for (const GroupAtNoise& level : levels) gains.push_back(level.log_probability + level.gain(factor));
    return log_sum(gains);
  }
};

std::vector<int> members_of(const std::vector<RelevanceGroup>& groups, std::span<const int> which) {
  std::vector<int> members;
  for (const int g : which) members.insert(members.end(), groups[g].members.begin(), groups[g].members.end());
  return members;
}

/// The result of a maximisation over the factor, and of an integration over it.
struct Weighed {
  double factor = 0.0, log_bayes_factor = 0.0;
};

/// `log_prior`: of log f.
template <class LogPrior>
Weighed weigh(const ConditionalGroup& group, LogPrior log_prior) {
  std::array<double, grid_points> value;
  for (int i = 0; i < grid_points; ++i) value[i] = group.gain(factor_at(i)) + log_prior(factor_at(i));
  const auto best = static_cast<int>(std::max_element(value.begin(), value.end()) - value.begin());
  double sum = 0.0;
  for (const double v : value) sum += std::exp(v - value[best]);
  sum -= 0.5 * (std::exp(value.front() - value[best]) + std::exp(value.back() - value[best]));  // the trapezium rule
  return {factor_at(best), value[best] + std::log(sum * std::log(grid_ratio))};
}

/// Density of log f for a half-Cauchy f of scale 1 that is at most 1.
double log_half_cauchy(double f) {
  return std::log(4.0 / std::numbers::pi * f / (1.0 + f * f));
}

class Weighing {
 public:
  Weighing(const std::vector<TermsAtNoise>& levels, const std::vector<RelevanceGroup>& groups)
      : levels_(levels), groups_(groups), result_(groups.size()) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const bool alone = groups[g].own_size;
      const auto same = std::find_if(families_.begin(), families_.end(), [&](const std::vector<int>& family) {
        return !alone && !groups[family.front()].own_size && groups[family.front()].family == groups[g].family;
      });
      if (same == families_.end())
        families_.push_back({static_cast<int>(g)});
      else
        same->push_back(static_cast<int>(g));
    }
  }

  void start_with_all() {
    for (GroupRelevance& group : result_) group.factor = 1.0;
  }

  /// Coordinate ascent over terms of one size, then over the sizes of their joints.
  void run() {
    sweep([&] {
      double moved = 0.0;
      for (const std::vector<int>& family : families_) moved = std::max(moved, weigh_family(family));
      return moved;
    });
    sweep([&] {
      double moved = 0.0;
      for (const std::vector<int>& family : families_)
        if (family.size() > 1) moved = std::max(moved, weigh_members(family));
      return moved;
    });
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (result_[g].factor == 0.0 || groups_[g].own_size) result_[g].log_evidence_gain = gain_of(static_cast<int>(g));
  }

  /// With the sizes of a supported term's joints as they are expected: whether a joint has the term is uncertain, too.
  std::vector<GroupRelevance> expected() const {
    std::vector<GroupRelevance> expected = result_;
    for (const std::vector<int>& family : families_) {
      const double centre = common_size(family);
      if (family.size() < 2 || centre == 0.0) continue;
      for (const int g : family) {
        const Weighed joint = weigh_member(g, centre);
        const double probability = 1.0 / (1.0 + std::exp(-joint.log_bayes_factor));
        expected[g].factor = probability > least_probability ? std::sqrt(probability) * joint.factor : 0.0;
      }
    }
    return expected;
  }

  double total() const {
    std::vector<double> factors;
    for (const GroupRelevance& group : result_) factors.push_back(group.factor);
    double sum = log_evidence(levels_, groups_, factors);
    for (const std::vector<int>& family : families_) {
      double largest = 0.0;
      for (const int g : family) largest = std::max(largest, factors[g]);
      if (largest > 0.0) sum += log_half_cauchy(largest) - log_odds();
    }
    return sum;
  }

 private:
  template <class Step>
  static void sweep(Step step) {
    for (int i = 0; i < most_sweeps; ++i)
      if (step() < settled_step) return;
  }

  /// Log prior odds against a term: one of the candidates is expected to exist (Scott & Berger 2010).
  double log_odds() const { return std::log(static_cast<double>(families_.size()) + 1.0); }

  ConditionalGroup conditional(std::span<const int> which) const {
    const std::vector<int> own = members_of(groups_, which);
    std::vector<int> others;
    std::vector<double> precision;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (result_[g].factor == 0.0 || std::ranges::find(which, static_cast<int>(g)) != which.end()) continue;
      for (const int k : groups_[g].members)
        others.push_back(k), precision.push_back(1.0 / (result_[g].factor * result_[g].factor));
    }
    ConditionalGroup group;
    std::vector<double> probabilities;
    for (const TermsAtNoise& level : levels_) {
      group.levels.push_back(conditional(level, own, others, precision));
      probabilities.push_back(group.levels.back().log_probability);
    }
    const double total = log_sum(probabilities);
    for (GroupAtNoise& level : group.levels) level.log_probability -= total;
    return group;
  }

  static GroupAtNoise conditional(const TermsAtNoise& level, const std::vector<int>& own,
                                  const std::vector<int>& others, const std::vector<double>& precision) {
    const LinearisedTerms& terms = level.terms;
    MatrixXd information = terms.information(own, own);
    VectorXd image = terms.image(own);
    double log_probability = level.log_likelihood;
    if (!others.empty()) {
      const Eigen::Map<const VectorXd> p(precision.data(), static_cast<Eigen::Index>(precision.size()));
      const MatrixXd among = terms.information(others, others) + MatrixXd(p.asDiagonal());
      const MatrixXd covariance = invert_but_for_rounding(among), across = terms.information(own, others) * covariance;
      const VectorXd image_of_others = terms.image(others);
      information -= across * terms.information(others, own);
      image -= across * image_of_others;
      log_probability += 0.5 * (image_of_others.dot(covariance * image_of_others) + p.array().log().sum()) -
                         cholesky_but_for_rounding(among).diagonal().array().log().sum();
    }
    const SymmetricEigen eigen = symmetric_eigen(information);
    return {eigen.values.cwiseMax(0.0), eigen.vectors.transpose() * image, log_probability};
  }

  static double steps_between(double before, double after) {
    if ((before == 0.0) != (after == 0.0)) return grid_points;
    return before == 0.0 ? 0.0 : std::abs(std::log(after / before)) / std::log(grid_ratio);
  }

  double set(int g, double factor, double gain) {
    const double moved = steps_between(result_[g].factor, factor);
    result_[g] = {factor, gain};
    return moved;
  }

  /// One size for the whole term.
  double weigh_family(const std::vector<int>& family) {
    const Weighed term = weigh(conditional(family), log_half_cauchy);
    const double gain = term.log_bayes_factor - log_odds();
    double moved = 0.0;
    for (const int g : family) moved = std::max(moved, set(g, gain > 0.0 ? term.factor : 0.0, gain));
    return moved;
  }

  /// Geometric mean over the joints that have the term; 0: none has.
  double common_size(const std::vector<int>& family) const {
    double sum = 0.0, count = 0.0;
    for (const int g : family)
      if (result_[g].factor > 0.0) sum += std::log(result_[g].factor), count += 1.0;
    return count > 0.0 ? std::exp(sum / count) : 0.0;
  }

  Weighed weigh_member(int g, double centre) const {
    return weigh(conditional(std::span(&g, 1)), [&](double f) {
      const double z = std::log(f / centre) / local_spread;
      return -0.5 * z * z - std::log(local_spread * std::sqrt(2.0 * std::numbers::pi));
    });
  }

  /// Sizes of a term's joints about their geometric mean; in a term without support, single joints that stand out.
  double weigh_members(const std::vector<int>& family) {
    const double centre = common_size(family);
    double moved = 0.0;
    for (const int g : family) {
      const Weighed joint =
          centre > 0.0 ? weigh_member(g, centre) : weigh(conditional(std::span(&g, 1)), log_half_cauchy);
      const double against = centre > 0.0 ? 0.0 : log_odds() + std::log(static_cast<double>(family.size()));
      const double gain = joint.log_bayes_factor - against;
      moved = std::max(moved, set(g, gain > 0.0 ? joint.factor : 0.0, gain));
    }
    return moved;
  }

  double gain_of(int g) const {
    return weigh(conditional(std::span(&g, 1)), log_half_cauchy).log_bayes_factor - log_odds();
  }

  const std::vector<TermsAtNoise>& levels_;
  const std::vector<RelevanceGroup>& groups_;
  std::vector<std::vector<int>> families_;
  std::vector<GroupRelevance> result_;
};

}  // namespace

double log_evidence(const LinearisedTerms& terms, const VectorXd& factors) {
  const SymmetricEigen eigen = symmetric_eigen(factors.asDiagonal() * terms.information * factors.asDiagonal());
  const VectorXd s = eigen.values.cwiseMax(0.0), q = eigen.vectors.transpose() * factors.cwiseProduct(terms.image);
  return 0.5 * (q.array().square() / (1.0 + s.array()) - s.array().log1p()).sum();
}

double log_evidence(const std::vector<TermsAtNoise>& levels, const std::vector<RelevanceGroup>& groups,
                    std::span<const double> factors) {
  std::vector<double> with, without;
  for (const TermsAtNoise& level : levels) {
    VectorXd of_parameters = VectorXd::Zero(level.terms.image.size());
    for (std::size_t g = 0; g < groups.size(); ++g)
      for (const int k : groups[g].members) of_parameters[k] = factors[g];
    without.push_back(level.log_likelihood);
    with.push_back(level.log_likelihood + log_evidence(level.terms, of_parameters));
  }
  return log_sum(with) - log_sum(without);
}

double joint_log_evidence_gain(const std::vector<TermsAtNoise>& levels, const std::vector<RelevanceGroup>& groups,
                               std::vector<double> factors, int family) {
  const double with = log_evidence(levels, groups, factors);
  for (std::size_t g = 0; g < groups.size(); ++g)
    if (groups[g].family == family) factors[g] = 0.0;
  return with - log_evidence(levels, groups, factors);
}

const LinearisedTerms& without_terms(const std::vector<TermsAtNoise>& levels) {
  return std::ranges::max_element(levels, {}, &TermsAtNoise::log_likelihood)->terms;
}

std::vector<GroupRelevance> weigh_groups(const std::vector<TermsAtNoise>& levels,
                                         const std::vector<RelevanceGroup>& groups) {
  Weighing from_none(levels, groups), from_all(levels, groups);
  from_all.start_with_all();
  from_none.run(), from_all.run();
  return from_all.total() > from_none.total() ? from_all.expected() : from_none.expected();
}

}  // namespace kinfer::calibrate
