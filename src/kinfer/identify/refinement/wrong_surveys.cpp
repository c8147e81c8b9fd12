// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/wrong_surveys.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinfer/estimate/continuous/fit_comparison.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {
namespace {

constexpr std::size_t most_candidates = 3;  // that are left out in turn, largest residual first
constexpr std::size_t least_points = 4;     // that remain: three fix the surveyor's frame alone

/// [m] of each surveyed point from where the fit puts it.
std::vector<double> survey_residuals(const RefinementFit& fitted) {
  std::vector<double> residuals;
  for (const InsSurveyedPoint& fact : fitted.setup.problem.facts.surveyed) {
    const InsUnknowns& x = fitted.fit.unknowns;
    const Vec3 position = point_position(fitted.setup.problem, fitted.fit.layout, x, fact.point, fact.at);
    residuals.push_back((x.facts.surveyor * fact.xyz - position).norm());
  }
  return residuals;
}

/// [m] rms distance of the surveyed points from their mean.
double span_of(const std::vector<InsSurveyedPoint>& points) {
  Vec3 mean = Vec3::Zero();
  for (const InsSurveyedPoint& point : points) mean += point.xyz / static_cast<double>(points.size());
  double square = 0.0;
  for (const InsSurveyedPoint& point : points) square += (point.xyz - mean).squaredNorm();
  return std::sqrt(square / static_cast<double>(points.size()));
}

/// What a point that is left out must explain, in ln likelihood, before it is wrong with even odds.
double needed_gain(const std::vector<InsSurveyedPoint>& points, std::size_t index) {
  return -std::log(wrong_survey_prior) + 3.0 * std::log(std::max(1.0, span_of(points) / points[index].sd));
}

/// The fit without one of the points.
struct Candidate {
  std::size_t index = 0;
  double log_odds = 0.0;
  RefinementFit fit;
};

Candidate without_point(const RefinementTask& task, const RefinementFit& fitted, std::size_t index) {
  Candidate candidate{index, 0.0, refit_with(task, fitted, [&](RefinementSetup& setup) {
                        auto& surveyed = setup.problem.facts.surveyed;
                        surveyed.erase(surveyed.begin() + static_cast<std::ptrdiff_t>(index));
                      })};
  const auto likelihood = [](const RefinementFit& fit) {
    return negative_log_likelihood(fit.setup.problem, fit.fit.cost);
  };
  candidate.log_odds =
      0.5 * (likelihood(fitted) - likelihood(candidate.fit)) - needed_gain(fitted.setup.problem.facts.surveyed, index);
  return candidate;
}

/// The points of the largest residuals, where all residuals together could pay for a wrong one.
std::vector<std::size_t> suspects(const RefinementFit& fitted) {
  const std::vector<InsSurveyedPoint>& points = fitted.setup.problem.facts.surveyed;
  if (points.size() <= least_points) return {};
  std::vector<double> ratios = survey_residuals(fitted);
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ratios[i] /= points[i].sd;
    squares += ratios[i] * ratios[i];
  }
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return ratios[a] > ratios[b]; });
  if (0.5 * squares < needed_gain(points, order.front())) return {};
  order.resize(std::min(order.size(), most_candidates));
  return order;
}

/// [m] of a point that was left out from where the others put it.
double distance_from_others(const RefinementFit& without, const InsSurveyedPoint& fact) {
  const InsUnknowns& x = without.fit.unknowns;
  return (x.facts.surveyor * fact.xyz -
          point_position(without.setup.problem, without.fit.layout, x, fact.point, fact.at))
      .norm();
}

}  // namespace

std::vector<Finding> leave_out_wrong_surveys(InsFacts& facts, const RefinementTask& task, RefinementFit& fitted) {
  std::vector<Finding> findings;
  std::vector<int> number(facts.surveyed.size());  // of each point that is left, as the file counts
  std::iota(number.begin(), number.end(), 0);
  for (;;) {
    std::vector<Candidate> candidates;
    for (const std::size_t index : suspects(fitted)) candidates.push_back(without_point(task, fitted, index));
    std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) { return a.log_odds > b.log_odds; });
    if (candidates.empty() || candidates[0].log_odds < clear_survey_log_odds) return findings;
    Candidate& worst = candidates[0];
    const bool is_clear = candidates.size() < 2 || worst.log_odds - candidates[1].log_odds > clear_survey_log_odds;
    const InsSurveyedPoint point = facts.surveyed[worst.index];
    findings.push_back({.kind = FindingKind::gross_outliers,
                        .severity = is_clear ? Severity::warning : Severity::fault,
                        .rows = {number[worst.index]},
                        .values = {{"facts", "surveyed points"},
                                   {"distance", distance_from_others(worst.fit, point)},
                                   {"sigma", point.sd}},
                        .applied = is_clear});
    if (!is_clear) return findings;
    const auto at = static_cast<std::ptrdiff_t>(worst.index);
    facts.surveyed.erase(facts.surveyed.begin() + at);
    number.erase(number.begin() + at);
    fitted = std::move(worst.fit);
  }
}

}  // namespace kinfer::identify
