#include "kinfer/calibrate/wrong_rows.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace kinfer {
namespace {

/// Largest headline error of each row [m] by a chain that was fitted on `seen`.
std::map<int, double> errors_by_row(const Chain& chain, const PoseSet& seen, const PoseSet& rows) {
  std::map<int, double> largest;
  const std::vector<double> errors = headline_errors(chain, seen, rows);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    double& error = largest[residual_kind(*headline_kind(rows)).row(rows, i)];
    error = std::max(error, errors[i]);
  }
  return largest;
}

}  // namespace

Result<std::vector<Outlier>> wrong_beside_geometry(const CalibrateTask& task, const RowsPlan& plan,
                                                   const ParameterChoice& parameters, const Estimate& geometry,
                                                   Rng rng) {
  if (plan.result_sees_all_rows) return geometry.outliers;
  KINFER_TRY(of_all_rows, fit_with_believable_tolerances(task, task.data, parameters, rng));
  return of_all_rows.estimate.outliers;
}

std::vector<Outlier> wrong_beside_both(const Estimate& geometry, const Estimate& richest, const PoseSet& rows) {
  constexpr double by_far = 11.0;  // [sigma]: twice what the best row of a thousand may have by chance
  constexpr double no_nearer = 0.5;
  std::vector<Outlier> wrong;
  if (richest.outliers.empty()) return wrong;
  const std::map<int, double> plain = errors_by_row(geometry.chain, rows, rows),
                              rich = errors_by_row(richest.chain, rows, rows);
  for (const Outlier& outlier : richest.outliers)
    if (outlier.sigmas > by_far && rich.contains(outlier.row) &&
        plain.at(outlier.row) >= no_nearer * rich.at(outlier.row))
      wrong.push_back(outlier);
  return wrong;
}

std::vector<Outlier> without_explained(const std::vector<Outlier>& wrong, const Estimate& chosen, const PoseSet& fitted,
                                       const PoseSet& data) {
  constexpr double explained = 4.0;  // [sigma]: one point of a thousand is further off by chance
  const std::map<int, double> error = errors_by_row(chosen.chain, fitted, data);
  std::vector<Outlier> left = wrong;
  std::erase_if(left, [&](const Outlier& outlier) {
    return error.contains(outlier.row) && error.at(outlier.row) <= explained * chosen.sigma;
  });
  return left;
}

LeftOut left_out_of_figures(const std::vector<Outlier>& wrong, const RowsPlan& plan) {
  std::set<int> held_out, rows;
  for (const Split& split : plan.proofs) held_out.insert(split.holdout.begin(), split.holdout.end());
  for (const Outlier& outlier : wrong)
    if (held_out.contains(outlier.row)) rows.insert(outlier.row);
  constexpr std::size_t too_many = 3;  // one in three
  if (too_many * rows.size() >= held_out.size()) return {{}, !rows.empty(), rows.size()};
  return {{rows.begin(), rows.end()}, false, rows.size()};
}

}  // namespace kinfer
