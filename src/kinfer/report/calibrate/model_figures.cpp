// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/report/calibrate/figures.hpp"
#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/plot.hpp"
#include "kinfer/report/parts/quantile.hpp"

namespace kinfer::report {
namespace {

/// Predicted errors of the workspace in classes from the smallest to nearly the largest.
struct HeatScale {
  static constexpr int classes = 5;
  double low = 0.0, high = 1.0;  ///< [mm]

  int class_of(double value) const {
    if (!(high > low) || !std::isfinite(value)) return 0;
    return static_cast<int>(std::clamp((value - low) / (high - low) * classes, 0.0, classes - 1.0));
  }
  double lower_limit(int k) const { return low + (high - low) * k / classes; }
};

/// Widens two axes so that a metre is equally long on both.
void make_isometric(svg::Axis& x, svg::Axis& y, double width, double height) {
  const double scale = std::max((x.high - x.low) / width, (y.high - y.low) / height);
  const auto widen = [](svg::Axis& axis, double extent) {
    const double more = 0.5 * (extent - (axis.high - axis.low));
    axis.low -= more, axis.high += more;
  };
  widen(x, scale * width), widen(y, scale * height);
}

std::string workspace_view(const std::vector<double>& right, const std::vector<double>& up,
                           const std::vector<double>& predicted, const HeatScale& scale, const char* right_name,
                           const char* up_name) {
  constexpr double width = 480.0, height = 400.0;
  svg::Axis x = svg::axis_for(right_name, right, svg::From::least), y = svg::axis_for(up_name, up, svg::From::least);
  make_isometric(x, y, width - 70.0, height - 56.0);
  svg::Plot plot(x, y, {width, height});
  for (int heat = 0; heat < HeatScale::classes; ++heat) {  // the most uncertain points on top
    std::vector<double> xs, ys;
    for (std::size_t i = 0; i < predicted.size(); ++i)
      if (std::isfinite(predicted[i]) && scale.class_of(predicted[i]) == heat)
        xs.push_back(right[i]), ys.push_back(up[i]);
    plot.cloud(xs, ys, 3.4, fmt::format("heat{}", heat));
  }
  return plot.svg("Uncertainty of the calibrated model over the workspace");
}

std::string scale_legend(const HeatScale& scale) {
  std::string text = "<p class=\"legend\">";
  for (int k = 0; k < HeatScale::classes; ++k)
    text += fmt::format("<span><i class=\"heat{}\"></i>{}{}</span>", k, html::short_number(scale.lower_limit(k)),
                        k == HeatScale::classes - 1 ? " mm and more" : "");
  return text + "</p>";
}

/// The held-out errors of a model; those of the fitted rows where no rows were held out.
const ErrorStatistics& reported_errors(const ModelRecord& model) {
  return model.holdout.n > 0 ? model.holdout : model.train;
}

}  // namespace

std::string workspace_map(const CalibrationEvidence& evidence) {
  std::vector<double> predicted;
  std::array<std::vector<double>, 3> tool;
  for (const WorkspacePoint& point : evidence.picture.workspace) {
    predicted.push_back(1e3 * point.predicted);
    for (std::size_t k = 0; k < 3; ++k) tool[k].push_back(point.tool[static_cast<Eigen::Index>(k)]);
  }
  const std::vector<double> sorted = finite_sorted(predicted);
  if (sorted.empty()) return "";
  const HeatScale scale{sorted.front(), std::max(quantile(sorted, 0.98), sorted.front() * 1.001)};
  return scale_legend(scale) + "<div class=\"two\">" +
         workspace_view(tool[0], tool[1], predicted, scale, "x [m], seen from above", "y [m]") +
         workspace_view(tool[0], tool[2], predicted, scale, "x [m], seen from the side", "z [m]") + "</div>";
}

std::string singular_value_plot(const CalibrationEvidence& evidence) {
  const VectorXd& values = evidence.identifiability.singular_values;
  if (values.size() == 0) return "";
  std::vector<double> with_border(values.begin(), values.end());
  with_border.push_back(1.0), with_border.push_back(0.2);
  svg::Axis y = svg::log_axis_for("data / tolerance", with_border);
  y.low = std::max(y.low, 1e-4);
  svg::Plot plot({.label = "combination of parameters", .low = 0.0, .high = static_cast<double>(values.size()) + 1.0},
                 y);
  plot.across(1.0, "border", "above: determined by the data");
  for (Eigen::Index i = 0; i < values.size(); ++i)
    plot.dot(static_cast<double>(i + 1), std::max(values[i], y.low), 3.6, values[i] > 1.0 ? "fill-after" : "fill-open",
             {}, fmt::format("combination {}: {}", i + 1, html::short_number(values[i])));
  return plot.svg("Singular values in units of noise and tolerance");
}

std::string correlation_map(const CalibrationEvidence& evidence) {
  const MatrixXd& covariance = evidence.covariance;
  const auto count = static_cast<Eigen::Index>(evidence.parameters.size());
  if (count == 0 || covariance.rows() != count || covariance.cols() != count) return "";
  std::vector<std::string> names;
  std::vector<std::vector<double>> correlation;
  for (const ParameterEstimate& p : evidence.parameters) names.push_back(p.name);
  for (Eigen::Index i = 0; i < count; ++i) {
    std::vector<double>& row = correlation.emplace_back();
    for (Eigen::Index k = 0; k < count; ++k) {
      const double scale = std::sqrt(covariance(i, i)) * std::sqrt(covariance(k, k));
      row.push_back(scale > 0 ? covariance(i, k) / scale : 0.0);
    }
  }
  return html::legend({{"plus", "positive"}, {"minus", "negative"}}) +
         svg::heat_map(names, correlation, "Correlation of the parameters' errors");
}

std::string model_selection_plot(const CalibrationEvidence& evidence) {
  double widest = 1e-12;
  for (const ModelRecord& model : evidence.model.models)
    if (!model.skipped) widest = std::max(widest, 1e3 * reported_errors(model).max);
  std::string text = "<div class=\"gain model-selection\">";
  for (const ModelRecord& model : evidence.model.models) {
    if (model.skipped) continue;
    const double mean = 1e3 * reported_errors(model).mean, worst = 1e3 * reported_errors(model).max;
    text += fmt::format(
        "<div class=\"gain-row {}\"><span class=\"gain-name\">{}</span><span class=\"gain-track\"><i "
        "style=\"width:{:.1f}%\"></i><u style=\"left:{:.1f}%\"></u></span><span class=\"gain-value\"><b>"
        "{}</b> mm <small>worst {}</small></span></div>",
        model.selected ? "after" : "before", html::escape(model.name), 100.0 * mean / widest, 100.0 * worst / widest,
        html::short_number(mean), html::short_number(worst));
  }
  return text + "</div>";
}

}  // namespace kinfer::report
