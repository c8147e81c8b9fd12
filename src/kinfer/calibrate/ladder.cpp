#include "kinfer/calibrate/ladder.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/far_splits.hpp"
#include "kinfer/calibrate/parameter_choice.hpp"
#include "kinfer/calibrate/rungs.hpp"
#include "kinfer/calibrate/wrong_rows.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

/// Errors of held-out rows [m], each by the fit that has not seen it.
struct HeldOut {
  std::vector<Estimate> unseen;  // one a split
  std::vector<double> errors;
  std::vector<int> row;  // of each error
};

/// A model fitted on all rows and without some: near, between the fitted poses, and far, beyond them.
struct Tried {
  Estimate fit;
  HeldOut near, far;
};

Estimate fit_rows(const Chain& start, const ParameterSet& set, const PoseSet& rows, const CalibrateTask& task,
                  const BundleOptions& options, const Observer& observer = {}) {
  return fit_bundle(start, seen_in(set, rows), rows, task.instrument, options, observer);
}

HeldOut cross_validated(const Estimate& fit, const ParameterSet& set, const PoseSet& rows,
                        const std::vector<Split>& splits, const CalibrateTask& task, int threads) {
  HeldOut held;
  held.unseen.resize(splits.size());
  parallel_for(splits.size(), threads, [&](std::size_t i) {
    held.unseen[i] = fit_rows(fit.chain, set, select(rows, splits[i].train), task,
                              {.begin = Begin::near_the_fit, .detail = Detail::numbers_only});
  });
  const auto headline = headline_kind(rows);
  if (!headline) return held;
  for (std::size_t i = 0; i < splits.size(); ++i) {
    const PoseSet judged = select(rows, splits[i].holdout);
    const std::vector<double> errors = headline_errors(held.unseen[i].chain, select(rows, splits[i].train), judged);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      held.errors.push_back(errors[k]);
      held.row.push_back(splits[i].holdout[residual_kind(*headline).row(judged, k)]);
    }
  }
  return held;
}

bool contains(const std::vector<Outlier>& list, int row) {
  return std::any_of(list.begin(), list.end(), [&](const Outlier& o) { return o.row == row; });
}

/// Statistics of the rows that are not wrong.
ErrorStatistics judged(const HeldOut& held, const std::vector<Outlier>& wrong) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < held.errors.size(); ++i)
    if (!contains(wrong, held.row[i])) errors.push_back(held.errors[i]);
  return error_statistics(errors);
}

ErrorStatistics trained(const Tried& tried, const PoseSet& rows) {
  const PoseSet believed = select(rows, without(all_rows(rows), tried.fit.outliers));
  return error_statistics(headline_errors(tried.fit.chain, rows, believed));
}

/// Held-out errors of both models side by side; a row counts unless both disbelieve it.
struct Comparison {
  double mean_before = 0.0, mean_after = 0.0, worst_before = 0.0, worst_after = 0.0;  // [m]
  double t = 0.0;  // mean gain in units of its standard error
};

Comparison compare(const Tried& before, const Tried& after, HeldOut Tried::*which) {
  const HeldOut &old = before.*which, &now = after.*which;
  std::vector<double> gain, a, b;
  for (std::size_t i = 0; i < old.errors.size(); ++i) {
    if (contains(before.fit.outliers, old.row[i]) && contains(after.fit.outliers, old.row[i])) continue;
    gain.push_back(old.errors[i] - now.errors[i]);
    a.push_back(old.errors[i]), b.push_back(now.errors[i]);
  }
  Comparison c;
  if (gain.size() < 2) return c;
  c.mean_before = mean(a), c.mean_after = mean(b);
  c.worst_before = *std::max_element(a.begin(), a.end()), c.worst_after = *std::max_element(b.begin(), b.end());
  c.t = mean(gain) / (standard_deviation(gain) / std::sqrt(static_cast<double>(gain.size())) + 1e-300);
  return c;
}

std::string in_fine_millimetres(double metres) {
  return fmt::format("{:.4f} mm", 1e3 * metres);
}

/// Whether the rung helps between the fitted poses; the sentence that says why, or what it goes from and to.
bool helps(const Comparison& c, double worst_of_geometry, std::string& why) {
  constexpr double certain = 2.5;      // standard errors
  constexpr double worth_it = 0.01;    // of the mean error: less is not worth a term
  constexpr double worst_slack = 1.0;  // times the worst error before: no pose may pay for the others
  const std::string means = fmt::format("the held-out mean goes from {} to {}", in_fine_millimetres(c.mean_before),
                                        in_fine_millimetres(c.mean_after));
  if (c.mean_after >= (1.0 - worth_it) * c.mean_before) {
    why = "refused: " + means;
    return false;
  }
  if (c.t < certain) {
    why = fmt::format("refused: {}, which chance explains ({:.1f} standard errors)", means, c.t);
    return false;
  }
  if (c.worst_after > worst_slack * std::max(c.worst_before, worst_of_geometry)) {
    why = fmt::format("refused: {}, but the worst held-out error rises from {} to {}", means,
                      in_fine_millimetres(c.worst_before), in_fine_millimetres(c.worst_after));
    return false;
  }
  why = fmt::format("{} ({:.0f} standard errors)", means, c.t);
  return true;
}

/// Whether a rung that helps between the fitted poses does no harm beyond them; completes the sentence.
bool holds_beyond(const Comparison& far, std::string& why) {
  constexpr double far_slack = 1.02;  // times the error before
  const std::string means =
      fmt::format("from {} to {}", in_fine_millimetres(far.mean_before), in_fine_millimetres(far.mean_after));
  if (far.mean_after > far_slack * far.mean_before) {
    why = "refused: " + why + ", but beyond the fitted poses the mean rises " + means;
    return false;
  }
  why = "taken: " + why + (far.mean_before > 0.0 ? "; beyond the fitted poses " + means : "");
  return true;
}

/// Which of the rung's terms the data determine.
void describe_terms(LadderRung& entry, const Rung& rung, const Estimate& fit) {
  entry.terms = static_cast<int>(rung.further.size());
  for (const Parameter& term : rung.further) {
    const auto value = std::find_if(fit.values.begin(), fit.values.end(),
                                    [&](const ParameterEstimate& v) { return v.name == term.name; });
    if (value != fit.values.end() && value->identifiable)
      ++entry.determined;
    else
      entry.not_excited.push_back(term.name);
  }
}

class Climb {
 public:
  Climb(const CalibrateTask& task, const PoseSet& rows, const std::vector<Split>& splits,
        const CalibrateOptions& options, const Observer& observer)
      : task_(task), rows_(rows), splits_(splits), far_(far_splits(rows)), options_(options), observer_(observer) {}

  Climbed run(const Estimate& geometry) {
    begin_with(geometry);
    const auto* named = std::get_if<NamedModel>(&options_.model);
    for (const std::string& name : named ? named->rungs : rung_names()) try_rung(name, named != nullptr);
    if (ladder_.chosen != "geometry")  // what the data tell is said of the chosen model alone
      now_.fit = fit_rows(now_.fit.chain, now_.fit.parameters, rows_, task_, {.begin = Begin::near_the_fit});
    const std::vector<Outlier> wrong = wrong_rows(geometry);
    for (std::size_t i = 0; i < ladder_.rungs.size(); ++i) ladder_.rungs[i].holdout = judged(held_out_[i], wrong);
    return {now_.fit, now_.near.unseen, ladder_, wrong};
  }

 private:
  void begin_with(const Estimate& geometry) {
    now_.fit = geometry;
    now_.near = proof(now_, geometry.parameters, splits_);
    if (std::holds_alternative<AutoModel>(options_.model)) now_.far = proof(now_, geometry.parameters, far_);
    LadderRung entry{.name = "geometry", .adds = "the complete geometric set", .chosen = true};
    entry.train = trained(now_, rows_);
    entry.terms = static_cast<int>(geometry.values.size());
    entry.determined = geometry.identifiability.rank;
    entry.why = "where every robot begins";
    worst_of_geometry_ = judged(now_.near, geometry.outliers).max;
    add(entry, now_.near);
    ladder_.chosen = "geometry";
  }

  void add(const LadderRung& entry, const HeldOut& held) {
    ladder_.rungs.push_back(entry);
    held_out_.push_back({{}, held.errors, held.row});
  }

  std::vector<Outlier> wrong_rows(const Estimate& geometry) const {
    std::vector<Outlier> wrong = without_explained(geometry.outliers, now_.fit, rows_, rows_);
    for (const Outlier& outlier : wrong_beside_both(geometry, now_.fit, rows_))
      if (!contains(wrong, outlier.row)) wrong.push_back(outlier);
    return wrong;
  }

  HeldOut proof(const Tried& tried, const ParameterSet& set, const std::vector<Split>& splits) const {
    return cross_validated(tried.fit, set, rows_, splits, task_, options_.threads);
  }

  /// Tried beyond the fitted poses only where it helps between them.
  bool earns_its_place(Tried& next, const ParameterSet& set, std::string& why) const {
    if (!helps(compare(now_, next, &Tried::near), worst_of_geometry_, why)) return false;
    next.far = proof(next, set, far_);
    return holds_beyond(compare(now_, next, &Tried::far), why);
  }

  void try_rung(const std::string& name, bool must) {
    const Rung rung = rung_on(now_.fit.chain, name, task_, rows_, now_.fit);
    LadderRung entry{.name = name, .adds = rung.adds};
    entry.terms = static_cast<int>(rung.further.size());
    if (!rung.locked.empty()) {
      lock(entry, rung.locked);
      return;
    }
    ParameterSet set = now_.fit.parameters;
    set.parameters.insert(set.parameters.end(), rung.further.begin(), rung.further.end());
    Tried next;
    next.fit = fit_rows(rung.nominal, set, rows_, task_, {.detail = Detail::numbers_only}, observer_);
    describe_terms(entry, rung, next.fit);
    if (entry.determined == 0 && !must) {
      lock(entry, "these poses do not excite its terms");
      return;
    }
    next.near = proof(next, set, splits_);
    entry.train = trained(next, rows_);
    entry.chosen = must || earns_its_place(next, set, entry.why);
    if (must) entry.why = "asked for";
    add(entry, next.near);
    if (entry.chosen) {
      now_ = std::move(next);
      ladder_.chosen += " + " + name;
    }
  }

  void lock(LadderRung& entry, const std::string& why) {
    entry.locked = true;
    entry.why = "locked: " + why;
    add(entry, {});
  }

  const CalibrateTask& task_;
  const PoseSet& rows_;
  const std::vector<Split>& splits_;
  std::vector<Split> far_;
  const CalibrateOptions& options_;
  const Observer& observer_;
  Tried now_;
  Ladder ladder_;
  std::vector<HeldOut> held_out_;  // errors of each rung of the ladder
  double worst_of_geometry_ = 0.0;
};

}  // namespace

Climbed climb(const CalibrateTask& task, const PoseSet& rows, const Estimate& geometry,
              const std::vector<Split>& splits, const CalibrateOptions& options, const Observer& observer) {
  return Climb(task, rows, splits, options, observer).run(geometry);
}

}  // namespace kinfer
