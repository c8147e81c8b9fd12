// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/wrong_facts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinfer/estimate/continuous/fit_comparison.hpp"
#include "kinfer/estimate/continuous/solver/fact_residuals.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {
namespace {

constexpr std::size_t most_candidates = 3;  // of each kind that are left out in turn, largest residual first
constexpr std::size_t least_points = 4;     // that remain: three fix the surveyor's frame alone
constexpr double least_tape_ratio = 0.01;   // of residual to sd: what else is known is 100 times less certain than a
                                            // tape that is bent by less

enum class FactKind { surveyed_point, tape };

/// A fact that may be wrong.
struct Suspect {
  FactKind kind{};
  std::size_t index = 0;     // among those of its kind
  double ratio = 0.0;        // of its residual to its sd
  double needed_gain = 0.0;  // ln likelihood that it must cost before it is wrong with even odds
};

/// [m] rms distance of the surveyed points from their mean.
double span_of(const std::vector<InsSurveyedPoint>& points) {
  Vec3 mean = Vec3::Zero();
  for (const InsSurveyedPoint& point : points) mean += point.xyz / static_cast<double>(points.size());
  double square = 0.0;
  for (const InsSurveyedPoint& point : points) square += (point.xyz - mean).squaredNorm();
  return std::sqrt(square / static_cast<double>(points.size()));
}

/// `span` and `sd` [m]; `rows`: the dimension of the fact.
double needed_gain(double span, double sd, double rows) {
  return -std::log(wrong_fact_prior) + rows * std::log(std::max(1.0, span / sd));
}

/// All tapes and surveyed points, with their residuals.
struct Suspects {
  std::vector<Suspect> tapes, surveyed;
};

Suspects all_suspects(const RefinementFit& fitted) {
  const InsFacts& facts = fitted.setup.problem.facts;
  const auto rows = fact_rows(fitted.setup.problem, fitted.fit.layout, fitted.fit.unknowns);
  std::size_t row = 0;
  for (const InsRevisitedPoint& touch : facts.touches) row += touch.at.size();
  Suspects all;
  for (const InsTapeDistance& tape : facts.tapes)
    all.tapes.push_back(
        {FactKind::tape, all.tapes.size(), rows[row++].left.norm(), needed_gain(tape.length, tape.sd, 1.0)});
  const double span = facts.surveyed.empty() ? 0.0 : span_of(facts.surveyed);
  for (const InsSurveyedPoint& point : facts.surveyed)
    all.surveyed.push_back(
        {FactKind::surveyed_point, all.surveyed.size(), rows[row++].left.norm(), needed_gain(span, point.sd, 3.0)});
  return all;
}

void keep_largest(std::vector<Suspect>& suspects) {
  std::ranges::sort(suspects, std::greater{}, &Suspect::ratio);
  suspects.resize(std::min(suspects.size(), most_candidates));
}

/// Points, where all their residuals together could pay for a wrong one, and tapes that anything contradicts.
std::vector<Suspect> suspects(const RefinementFit& fitted) {
  auto [tapes, surveyed] = all_suspects(fitted);
  const double squares = std::accumulate(surveyed.begin(), surveyed.end(), 0.0,
                                         [](double sum, const Suspect& s) { return sum + s.ratio * s.ratio; });
  std::erase_if(tapes, [](const Suspect& tape) { return tape.ratio < least_tape_ratio; });
  if (surveyed.size() <= least_points) surveyed.clear();
  keep_largest(tapes);
  keep_largest(surveyed);
  if (!surveyed.empty() && 0.5 * squares < surveyed.front().needed_gain) surveyed.clear();
  std::ranges::copy(surveyed, std::back_inserter(tapes));
  return tapes;
}

/// Of tapes or surveyed points.
template <class Fact>
void leave_out(std::vector<Fact>& facts, std::size_t index) {
  facts.erase(facts.begin() + static_cast<std::ptrdiff_t>(index));
}

void leave_out(InsFacts& facts, const Suspect& suspect) {
  if (suspect.kind == FactKind::tape)
    leave_out(facts.tapes, suspect.index);
  else
    leave_out(facts.surveyed, suspect.index);
}

/// The fit without one of the facts.
struct WrongFactCandidate {
  Suspect suspect;
  double log_odds = 0.0;
  RefinementFit fit;
};

WrongFactCandidate without(const RefinementTask& task, const RefinementFit& fitted, const Suspect& suspect) {
  WrongFactCandidate candidate{
      suspect, 0.0, refit_with(task, fitted, [&](RefinementSetup& setup) { leave_out(setup.problem.facts, suspect); })};
  const auto likelihood = [](const RefinementFit& fit) {
    return negative_log_likelihood(fit.setup.problem, fit.fit.cost);
  };
  candidate.log_odds = 0.5 * (likelihood(fitted) - likelihood(candidate.fit)) - suspect.needed_gain;
  return candidate;
}

/// Most probably wrong first.
std::vector<WrongFactCandidate> candidates(const RefinementTask& task, const RefinementFit& fitted) {
  std::vector<WrongFactCandidate> all;
  for (const Suspect& suspect : suspects(fitted)) all.push_back(without(task, fitted, suspect));
  std::ranges::sort(all, std::greater{}, &WrongFactCandidate::log_odds);
  return all;
}

/// The numbers of the facts that are left, as the file counts.
struct FactNumbers {
  std::vector<int> tapes, surveyed;

  explicit FactNumbers(const InsFacts& facts) : tapes(facts.tapes.size()), surveyed(facts.surveyed.size()) {
    std::iota(tapes.begin(), tapes.end(), 0);
    std::iota(surveyed.begin(), surveyed.end(), 0);
  }
  std::vector<int>& of(FactKind kind) { return kind == FactKind::tape ? tapes : surveyed; }
};

/// [m] of a fact that was left out from what the others say.
double distance_from_others(const InsFacts& facts, const WrongFactCandidate& candidate) {
  RefinementSetup setup = candidate.fit.setup;  // with that fact alone
  InsFacts& alone = setup.problem.facts;
  const auto& [kind, index, ratio, gain] = candidate.suspect;
  alone.touches.clear(), alone.tapes.clear(), alone.surveyed.clear(), alone.azimuth = {};
  const bool is_tape = kind == FactKind::tape;
  if (is_tape)
    alone.tapes = {facts.tapes[index]};
  else
    alone.surveyed = {facts.surveyed[index]};
  const auto rows = fact_rows(setup.problem, candidate.fit.fit.layout, candidate.fit.fit.unknowns);
  return rows.front().left.norm() * (is_tape ? facts.tapes[index].sd : facts.surveyed[index].sd);
}

Finding finding_about(const InsFacts& facts, const WrongFactCandidate& wrong, int number, bool is_clear) {
  const bool is_tape = wrong.suspect.kind == FactKind::tape;
  const std::size_t index = wrong.suspect.index;
  return {.kind = FindingKind::gross_outliers,
          .severity = is_clear ? Severity::warning : Severity::fault,
          .rows = {number},
          .values = {{"facts", is_tape ? "tapes" : "surveyed points"},
                     {"distance", distance_from_others(facts, wrong)},
                     {"sigma", is_tape ? facts.tapes[index].sd : facts.surveyed[index].sd}},
          .applied = is_clear};
}

}  // namespace

std::vector<Finding> leave_out_wrong_facts(InsFacts& facts, const RefinementTask& task, RefinementFit& fitted) {
  std::vector<Finding> findings;
  FactNumbers numbers(facts);
  for (;;) {
    std::vector<WrongFactCandidate> all = candidates(task, fitted);
    if (all.empty() || all[0].log_odds < clear_fact_log_odds) return findings;
    WrongFactCandidate& wrong = all[0];
    const bool is_clear = all.size() < 2 || wrong.log_odds - all[1].log_odds > clear_fact_log_odds;
    std::vector<int>& of_kind = numbers.of(wrong.suspect.kind);
    findings.push_back(finding_about(facts, wrong, of_kind[wrong.suspect.index], is_clear));
    if (!is_clear) return findings;
    leave_out(of_kind, wrong.suspect.index);
    leave_out(facts, wrong.suspect);
    fitted = std::move(wrong.fit);
  }
}

}  // namespace kinfer::identify
