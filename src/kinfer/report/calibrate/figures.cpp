// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/calibrate/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/parts/chain_view.hpp"
#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/pages.hpp"
#include "kinfer/report/parts/plot.hpp"
#include "kinfer/report/parts/scene.hpp"

namespace kinfer::pages {
namespace {

using Json = nlohmann::json;

std::vector<double> in_millimetres(const Json& list) {
  std::vector<double> values = numbers(list);
  for (double& v : values) v *= 1e3;
  return values;
}

std::vector<double> finite_sorted(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  std::sort(values.begin(), values.end());
  return values;
}

double quantile(const std::vector<double>& sorted, double part) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto k = static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1) + 0.5);
  return sorted[std::min(k, sorted.size() - 1)];
}

std::set<int> outlier_rows(const Json& evidence) {
  std::set<int> rows;
  for (const Json& outlier : evidence.at("outliers")) rows.insert(outlier.at("row").get<int>());
  return rows;
}

Vec3 vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

/// Errors of the inlier rows [mm].
std::vector<double> inlier_errors(const Json& evidence, const char* key) {
  const std::set<int> wrong = outlier_rows(evidence);
  const std::vector<double> all = in_millimetres(evidence.at("rows").at(key));
  std::vector<double> kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!wrong.contains(static_cast<int>(i))) kept.push_back(all[i]);
  return kept;
}

/// Histogram with equal bins from 0 to `high`; the last bin includes larger values.
std::vector<double> counts(const std::vector<double>& values, double high, std::size_t bins) {
  std::vector<double> count(bins, 0.0);
  for (const double v : values)
    if (std::isfinite(v))
      count[std::min(bins - 1, static_cast<std::size_t>(v / high * static_cast<double>(bins)))] += 1;
  return count;
}

std::string legend(std::initializer_list<std::pair<const char*, const char*>> entries) {
  std::string text = "<p class=\"legend\">";
  for (const auto& [kind, words] : entries) text += fmt::format("<span><i class=\"{}\"></i>{}</span>", kind, words);
  return text + "</p>";
}

void draw_joint_axis(svg::Scene& scene, const JointPlacementView& joint, double half) {
  scene.line({joint.point - half * joint.axis, joint.point + half * joint.axis}, "joint-axis");
}

/// 1, 2 or 5 times a power of ten, at most `value`.
double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(std::max(value, 1.0)))),
               part = std::max(value, 1.0) / power;
  return power * (part >= 5.0 ? 5.0 : part >= 2.0 ? 2.0 : 1.0);
}

/// Error vectors at the measured points; returns their exaggeration factor.
double draw_errors(svg::Scene& scene, const Json& picture, double size) {
  const Json &measured = picture.at("measured"), &before = picture.at("off_before"), &after = picture.at("off_after");
  std::vector<double> lengths;
  for (const Json& off : before)
    if (!off.is_null()) lengths.push_back(vector_of(off).norm());
  const double typical = quantile(finite_sorted(lengths), 0.5);
  const double times = round_down(0.1 * size / (typical > 0.0 ? typical : 1e-3));
  const auto draw = [&](const Json& off, const char* kind) {
    std::vector<Vec3> pairs;
    for (std::size_t i = 0; i < measured.size(); ++i) {
      if (measured[i].is_null()) continue;
      const Vec3 point = vector_of(measured[i]);
      pairs.push_back(point), pairs.push_back(point + times * vector_of(off[i]));
    }
    scene.strokes(pairs, kind);
  };
  draw(before, "off-before");
  draw(after, "off-after");
  return times;
}

}  // namespace

double error_percentile_95(const Json& evidence) {
  return 1e-3 * quantile(finite_sorted(inlier_errors(evidence, "after")), 0.95);
}

std::string machine_drawing(const Json& evidence) {
  const Json& picture = evidence.at("picture");
  if (picture.at("chains").at("calibrated").at("joints").empty()) return "";
  const ChainView chain = chain_view(picture.at("chains").at("calibrated"));
  const std::vector<double> q = picture.at("q").empty() ? std::vector<double>{} : numbers(picture.at("q").at(0));
  const auto joints = placed(chain, q);
  svg::Scene scene;
  std::vector<Vec3> poses;
  for (const Json& point : picture.at("measured"))
    if (!point.is_null()) poses.push_back(vector_of(point));
  scene.dots(poses, 1.6, "pose");
  std::vector<Vec3> line{chain.base.position};
  for (const JointPlacementView& joint : joints) line.push_back(joint.frame.position);
  line.push_back(tool_pose(chain, joints).position);
  scene.line(line, "link");
  const double half = 0.12 * scene.radius();
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].axis.norm() > 0.0) {
      draw_joint_axis(scene, joints[i], half);
      scene.dot(joints[i].point, 3.5, "joint");
      scene.name(joints[i].point, chain.joints[i].name);
    }
  scene.dot(line.back(), 4.0, "tool");
  const double times = draw_errors(scene, picture, scene.radius());
  return scene.svg({640, 460}, "The calibrated chain in its first pose, and the measured points") +
         fmt::format(
             "<p class=\"note\">The robot in the first pose; at each measured point its error before (grey) and after "
             "(blue), {:.0f} times too long.</p>",
             times);
}

Headline headline(const Json& evidence) {
  const bool lengths = evidence.at("after").at("train").at("n").get<int>() > 0 ||
                       evidence.at("after").at("holdout").at("n").get<int>() > 0 ||
                       !evidence.at("after").contains("orientation_rad");
  const auto fit = [&](const char* which) -> const Json& {
    return lengths ? evidence.at(which) : evidence.at(which).at("orientation_rad");
  };
  Headline h;
  h.held_out = fit("after").at("holdout").at("n").get<int>() > 0;
  const char* side = h.held_out ? "holdout" : "train";
  const Json &before = fit("before").at(side), &after = fit("after").at(side);
  const double factor = lengths ? 1e3 : 1.0 / degree;
  h.mean_before = factor * before.at("mean").get<double>(), h.max_before = factor * before.at("max").get<double>();
  h.mean_after = factor * after.at("mean").get<double>(), h.max_after = factor * after.at("max").get<double>();
  h.n = after.at("n").get<int>();
  h.unit = lengths ? "mm" : "°";
  const std::string measured = string_at(evidence, "measured", "position");
  h.what = !lengths ? "the tool's orientation" : measured == "position" ? "the tool" : "the " + measured;
  return h;
}

std::string gain_drawing(const Json& evidence) {
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

std::string error_histogram(const Json& evidence) {
  const std::vector<double> before = inlier_errors(evidence, "before"), after = inlier_errors(evidence, "after");
  const std::vector<double> sorted = finite_sorted(before);
  if (sorted.empty()) return "";
  const double high = std::max(quantile(sorted, 0.99), quantile(finite_sorted(after), 0.99)) * 1.05 + 1e-9;
  const std::size_t bins = std::clamp<std::size_t>(sorted.size() / 3, 12, 48);
  const auto counts_before = counts(before, high, bins), counts_after = counts(after, high, bins);
  std::vector<double> both = counts_before;
  both.insert(both.end(), counts_after.begin(), counts_after.end());
  svg::Plot plot({.label = "error of the tool [mm]", .low = 0.0, .high = high},
                 svg::axis_for("poses", both, svg::From::zero));
  const double width = high / static_cast<double>(bins);
  const auto draw = [&](const std::vector<double>& count, const char* kind, const char* when) {
    for (std::size_t i = 0; i < bins; ++i)
      if (count[i] > 0.0)
        plot.bar(width * static_cast<double>(i), width * static_cast<double>(i + 1), 0.0, count[i], kind,
                 fmt::format("{}: {:.0f} poses from {:.3f} to {:.3f} mm", when, count[i],
                             width * static_cast<double>(i), width * static_cast<double>(i + 1)));
  };
  draw(counts_before, "fill-before", "before");
  draw(counts_after, "fill-after", "after");
  return legend({{"fill-before", "before"}, {"fill-after", "after"}}) +
         plot.svg("Histogram of the tool's error before and after the calibration");
}

std::string errors_per_pose(const Json& evidence) {
  const std::vector<double> before = in_millimetres(evidence.at("rows").at("before")),
                            after = in_millimetres(evidence.at("rows").at("after"));
  const Json& held = evidence.at("rows").at("held_out");
  const std::set<int> wrong = outlier_rows(evidence);
  std::vector<double> all;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (!wrong.contains(static_cast<int>(i))) all.push_back(before[i]), all.push_back(after[i]);
  if (finite_sorted(all).empty()) return "";
  const svg::Axis y = svg::axis_for("error of the tool [mm]", all, svg::From::zero);
  svg::Plot plot({.label = "row of the pose set", .low = -0.5, .high = static_cast<double>(before.size()) - 0.5}, y,
                 {.width = 980.0, .height = 270.0});
  const double radius = before.size() > 300 ? 1.7 : 2.8;
  std::vector<double> row, inliers_before = before;
  for (std::size_t i = 0; i < before.size(); ++i) {
    row.push_back(static_cast<double>(i));
    if (wrong.contains(static_cast<int>(i))) inliers_before[i] = NAN;
  }
  plot.cloud(row, inliers_before, 0.75 * radius, "fill-before");
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!std::isfinite(after[i])) continue;
    const bool outlier = wrong.contains(static_cast<int>(i));
    const std::string kind = outlier ? "fill-bad" : held.at(i).get<bool>() ? "fill-after" : "ring-after";
    plot.dot(row[i], std::min(after[i], y.high), outlier ? 1.3 * radius : radius, kind,
             fmt::format(" data-row=\"{}\"", i));
  }
  return legend({{"fill-before", "before"},
                 {"fill-after", "after, pose not fitted"},
                 {"ring-after", "after, pose fitted"},
                 {"fill-bad", "not believed"}}) +
         "<div class=\"scroll\" tabindex=\"0\"><div class=\"wide\">" +
         plot.svg("Error of the tool at each pose before and after the calibration") + "</div></div>";
}

std::string workspace_map(const Json& evidence) {
  const Json& workspace = evidence.at("picture").at("workspace");
  const std::vector<double> predicted = in_millimetres(workspace.at("predicted"));
  const std::vector<double> sorted = finite_sorted(predicted);
  if (sorted.empty()) return "";
  constexpr int classes = 5;
  const double low = sorted.front(), high = std::max(quantile(sorted, 0.98), low * 1.001);
  const auto class_of = [&](double v) {
    return std::clamp(static_cast<int>((v - low) / (high - low) * classes), 0, classes - 1);
  };
  std::vector<double> axis[3];
  for (const Json& tool : workspace.at("tool"))
    for (std::size_t k = 0; k < 3; ++k) axis[k].push_back(tool.at(k).get<double>());
  const auto view = [&](std::size_t right, std::size_t up, const char* right_name, const char* up_name) {
    svg::Axis x = svg::axis_for(right_name, axis[right], svg::From::least),
              y = svg::axis_for(up_name, axis[up], svg::From::least);
    constexpr double width = 480.0, height = 400.0, inner_width = width - 70.0, inner_height = height - 56.0;
    const double scale =
        std::max((x.high - x.low) / inner_width, (y.high - y.low) / inner_height);  // equal on both axes
    const auto widen = [](svg::Axis& a, double extent) {
      const double more = 0.5 * (extent - (a.high - a.low));
      a.low -= more, a.high += more;
    };
    widen(x, scale * inner_width), widen(y, scale * inner_height);
    svg::Plot plot(x, y, {width, height});
    for (int heat = 0; heat < classes; ++heat) {  // the most uncertain points on top
      std::vector<double> xs, ys;
      for (std::size_t i = 0; i < predicted.size(); ++i)
        if (std::isfinite(predicted[i]) && class_of(predicted[i]) == heat)
          xs.push_back(axis[right][i]), ys.push_back(axis[up][i]);
      plot.cloud(xs, ys, 3.4, fmt::format("heat{}", heat));
    }
    return plot.svg("Uncertainty of the calibrated model over the workspace");
  };
  std::string scale = "<p class=\"legend\">";
  for (int k = 0; k < classes; ++k)
    scale += fmt::format("<span><i class=\"heat{}\"></i>{}{}</span>", k,
                         html::short_number(low + (high - low) * k / classes), k == classes - 1 ? " mm and more" : "");
  return scale + "</p><div class=\"two\">" + view(0, 1, "x [m], seen from above", "y [m]") +
         view(0, 2, "x [m], seen from the side", "z [m]") + "</div>";
}

std::string singular_value_plot(const Json& evidence) {
  const std::vector<double> values = numbers(evidence.at("singular_values"));
  if (values.empty()) return "";
  std::vector<double> with_border = values;
  with_border.push_back(1.0), with_border.push_back(0.2);
  svg::Axis y = svg::log_axis_for("data / tolerance", with_border);
  y.low = std::max(y.low, 1e-4);
  svg::Plot plot({.label = "combination of parameters", .low = 0.0, .high = static_cast<double>(values.size()) + 1.0},
                 y);
  plot.across(1.0, "border", "above: the data know it");
  for (std::size_t i = 0; i < values.size(); ++i)
    plot.dot(static_cast<double>(i + 1), std::max(values[i], y.low), 3.6, values[i] > 1.0 ? "fill-after" : "fill-open",
             {}, fmt::format("combination {}: {:.3g}", i + 1, values[i]));
  return plot.svg("Singular values in units of noise and tolerance");
}

std::string correlation_map(const Json& evidence) {
  const Json &covariance = evidence.at("covariance"), &parameters = evidence.at("parameters");
  if (covariance.empty() || covariance.size() != parameters.size()) return "";
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  for (const Json& row : covariance) rows.push_back(numbers(row));
  for (const Json& p : parameters) names.push_back(p.at("name"));
  std::vector<double> sd;
  for (std::size_t i = 0; i < rows.size(); ++i) sd.push_back(std::sqrt(rows[i][i]));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < rows.size(); ++k) rows[i][k] = sd[i] * sd[k] > 0 ? rows[i][k] / (sd[i] * sd[k]) : 0.0;
  return legend({{"plus", "move together"}, {"minus", "move against each other"}}) +
         svg::heat_map(names, rows, "Correlation of the parameters' errors");
}

std::string ladder_plot(const Json& evidence) {
  const Json& rungs = evidence.at("model").at("rungs");
  const auto figure = [](const Json& rung, const char* which) {
    const Json& side = rung.at(rung.at("holdout").at("n").get<int>() > 0 ? "holdout" : "train");
    return 1e3 * side.at(which).get<double>();
  };
  double widest = 1e-12;
  for (const Json& rung : rungs)
    if (rung.contains("holdout")) widest = std::max(widest, figure(rung, "max"));
  std::string text = "<div class=\"gain ladder\">";
  for (const Json& rung : rungs) {
    if (!rung.contains("holdout")) continue;  // not tried
    const double mean = figure(rung, "mean"), worst = figure(rung, "max");
    text += fmt::format(
        "<div class=\"gain-row {}\"><span class=\"gain-name\">{}</span><span class=\"gain-track\"><i "
        "style=\"width:{:.1f}%\"></i><u style=\"left:{:.1f}%\"></u></span><span class=\"gain-value\"><b>"
        "{}</b> mm <small>worst {}</small></span></div>",
        rung.value("chosen", false) ? "after" : "before", html::escape(string_at(rung, "name")), 100.0 * mean / widest,
        100.0 * worst / widest, html::short_number(mean), html::short_number(worst));
  }
  return text + "</div>";
}

}  // namespace kinfer::pages
