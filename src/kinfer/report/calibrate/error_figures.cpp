// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/calibrate/figures.hpp"
#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/plot.hpp"
#include "kinfer/report/parts/quantile.hpp"

namespace kinfer::report {
namespace {

std::vector<double> errors_in_mm(const std::vector<RowErrors>& rows, double RowErrors::*error) {
  std::vector<double> values;
  for (const RowErrors& row : rows) values.push_back(1e3 * row.*error);
  return values;
}

std::set<int> outlier_rows(const CalibrationEvidence& evidence) {
  std::set<int> rows;
  for (const OutlierRecord& record : evidence.outliers) rows.insert(record.outlier.row);
  return rows;
}

/// Errors of the inlier rows [mm].
std::vector<double> inlier_errors(const CalibrationEvidence& evidence, double RowErrors::*error) {
  const std::set<int> wrong = outlier_rows(evidence);
  const std::vector<double> all = errors_in_mm(evidence.rows, error);
  std::vector<double> kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!wrong.contains(static_cast<int>(i))) kept.push_back(all[i]);
  return kept;
}

/// Histogram with equal bins from 0 to `high`; the last bin includes larger values.
std::vector<double> counts(const std::vector<double>& values, double high, std::size_t bins) {
  std::vector<double> count(bins, 0.0);
  for (const double v : values)
    if (std::isfinite(v) && high > 0.0)
      count[static_cast<std::size_t>(
          std::clamp(v / high * static_cast<double>(bins), 0.0, static_cast<double>(bins - 1)))] += 1;
  return count;
}

/// "the tool", or what else the errors refer to.
std::string measured_text(const CalibrationEvidence& evidence) {
  return evidence.measurement == kind_of<PointMeasurement> ? "the tool" : "the " + evidence.measured;
}

}  // namespace

double error_percentile_95(const CalibrationEvidence& evidence) {
  return 1e-3 * quantile(finite_sorted(inlier_errors(evidence, &RowErrors::after)), 0.95);
}

std::string measured_angle(const CalibrationEvidence& evidence) {
  return evidence.measurement == kind_of<TiltMeasurement> ? "the tilt" : "the tool's orientation";
}

Headline headline(const CalibrationEvidence& evidence) {
  const ChainFit& after = evidence.after;
  const bool lengths = after.position.train.n > 0 || after.position.holdout.n > 0 || after.orientation.train.n == 0;
  const auto kind = lengths ? &ChainFit::position : &ChainFit::orientation;
  Headline h;
  h.held_out = (after.*kind).holdout.n > 0;
  const auto side = h.held_out ? &TrainHoldout::holdout : &TrainHoldout::train;
  const ErrorStatistics &old_errors = evidence.before.*kind.*side, &new_errors = after.*kind.*side;
  const double factor = lengths ? 1e3 : 1.0 / degree;
  h.mean_before = factor * old_errors.mean, h.max_before = factor * old_errors.max;
  h.mean_after = factor * new_errors.mean, h.max_after = factor * new_errors.max;
  h.n = new_errors.n;
  h.unit = lengths ? "mm" : "°";
  h.what = lengths ? measured_text(evidence) : measured_angle(evidence);
  return h;
}

std::string gain_drawing(const CalibrationEvidence& evidence) {
  const Headline h = headline(evidence);
  const double widest = std::max({h.max_before, h.max_after, 1e-12});
  const auto bar = [&](const char* kind, double mean, double worst) {
    return fmt::format(
        "<div class=\"gain-row {0}\"><span class=\"gain-name\">{0}</span><span class=\"gain-track\">"
        "<i style=\"width:{1:.1f}%\"></i><u style=\"left:{2:.1f}%\"></u></span><span class=\"gain-value\">"
        "<b>{3}</b> {5} <small>worst {4}</small></span></div>",
        kind, 100.0 * mean / widest, 100.0 * worst / widest, html::short_number(mean), html::short_number(worst),
        h.unit);
  };
  return "<div class=\"gain\" role=\"img\" aria-label=\"Mean error before and after\">" +
         bar("before", h.mean_before, h.max_before) + bar("after", h.mean_after, h.max_after) + "</div>";
}

std::string error_histogram(const CalibrationEvidence& evidence) {
  const std::vector<double> before = inlier_errors(evidence, &RowErrors::before),
                            after = inlier_errors(evidence, &RowErrors::after);
  const std::vector<double> sorted = finite_sorted(before), sorted_after = finite_sorted(after);
  if (sorted.empty()) return "";
  const double largest_after = sorted_after.empty() ? 0.0 : quantile(sorted_after, 0.99);
  const double high = std::max(quantile(sorted, 0.99), largest_after) * 1.05 + 1e-9;
  const std::size_t bins = std::clamp<std::size_t>(sorted.size() / 3, 12, 48);
  const auto counts_before = counts(before, high, bins), counts_after = counts(after, high, bins);
  std::vector<double> both = counts_before;
  both.insert(both.end(), counts_after.begin(), counts_after.end());
  svg::Plot plot({.label = "error of the tool [mm]", .low = 0.0, .high = high},
                 svg::axis_for("poses", both, svg::From::zero));
  const double width = high / static_cast<double>(bins);
  const auto draw = [&](const std::vector<double>& count, const char* kind, const char* when) {
    for (std::size_t i = 0; i < bins; ++i) {
      const double low_edge = width * static_cast<double>(i), high_edge = width * static_cast<double>(i + 1);
      if (count[i] > 0.0)
        plot.bar(low_edge, high_edge, 0.0, count[i], kind,
                 fmt::format("{}: {:.0f} poses from {:.3f} to {:.3f} mm", when, count[i], low_edge, high_edge));
    }
  };
  draw(counts_before, "fill-before", "before");
  draw(counts_after, "fill-after", "after");
  return html::legend({{"fill-before", "before"}, {"fill-after", "after"}}) +
         plot.svg("Histogram of the tool's error before and after the calibration");
}

std::string errors_per_pose(const CalibrationEvidence& evidence) {
  const std::vector<double> before = errors_in_mm(evidence.rows, &RowErrors::before),
                            after = errors_in_mm(evidence.rows, &RowErrors::after);
  const std::set<int> wrong = outlier_rows(evidence);
  std::vector<double> all, row, inliers_before = before;
  for (std::size_t i = 0; i < before.size(); ++i) {
    row.push_back(static_cast<double>(i));
    if (wrong.contains(static_cast<int>(i)))
      inliers_before[i] = NAN;
    else
      all.push_back(before[i]), all.push_back(after[i]);
  }
  if (finite_sorted(all).empty()) return "";
  const svg::Axis y = svg::axis_for("error of the tool [mm]", all, svg::From::zero);
  svg::Plot plot({.label = "row of the pose set", .low = -0.5, .high = static_cast<double>(before.size()) - 0.5}, y,
                 {.width = 980.0, .height = 270.0});
  const double radius = before.size() > 300 ? 1.7 : 2.8;
  plot.cloud(row, inliers_before, 0.75 * radius, "fill-before");
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!std::isfinite(after[i])) continue;
    const bool outlier = wrong.contains(static_cast<int>(i));
    const std::string kind = outlier ? "fill-bad" : evidence.rows[i].held_out ? "fill-after" : "ring-after";
    plot.dot(row[i], std::min(after[i], y.high), outlier ? 1.3 * radius : radius, kind,
             fmt::format(" data-row=\"{}\"", i));
  }
  return html::legend({{"fill-before", "before"},
                       {"fill-after", "after, pose not fitted"},
                       {"ring-after", "after, pose fitted"},
                       {"fill-bad", "outlier"}}) +
         "<div class=\"scroll\" tabindex=\"0\"><div class=\"wide\">" +
         plot.svg("Error of the tool at each pose before and after the calibration") + "</div></div>";
}

}  // namespace kinfer::report
