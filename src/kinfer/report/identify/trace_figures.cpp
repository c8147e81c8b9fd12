// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/report/identify/figures.hpp"
#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/plot.hpp"

namespace kinfer::report {
namespace {

bool is_acceleration(const Trace& trace) {
  return trace.quantity == TraceQuantity::acceleration;
}

std::string quantity_text(const Trace& trace) {
  return is_acceleration(trace) ? "acceleration" : "angular velocity";
}

/// "m/s²"
std::string unit_text(const Trace& trace) {
  return is_acceleration(trace) ? "m/s²" : "rad/s";
}

double residual_rms(const Trace& trace) {
  return trace.rms_holdout > 0.0 ? trace.rms_holdout : trace.rms_fitted;
}

/// The axis with the largest range; zero counts as measured.
std::size_t most_active_axis(const Trace& trace) {
  std::size_t best = 0;
  double widest = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double low = 0.0, high = 0.0;
    for (const double v : trace.measured[k].low)
      if (v < low) low = v;
    for (const double v : trace.measured[k].high)
      if (v > high) high = v;
    if (high - low > widest) widest = high - low, best = k;
  }
  return best;
}

/// Merges every `step` bins into one.
Envelope decimate(const Envelope& envelope, std::size_t step) {
  Envelope merged;
  for (std::size_t i = 0; i < envelope.low.size(); i += step) {
    double low = NAN, high = NAN;
    for (std::size_t k = i; k < std::min(i + step, envelope.low.size()); ++k)
      low = std::fmin(low, envelope.low[k]), high = std::fmax(high, envelope.high[k]);  // without the missing
    merged.low.push_back(low), merged.high.push_back(high);
  }
  return merged;
}

std::string trace_drawing(const MotionEvidence& motion, const Trace& trace) {
  constexpr std::size_t bins_on_paper = 250;
  const std::vector<double>& time = motion.time;
  const std::size_t step = std::max<std::size_t>(1, time.size() / bins_on_paper), axis = most_active_axis(trace);
  const Envelope measured = decimate(trace.measured[axis], step), predicted = decimate(trace.predicted[axis], step),
                 residual = decimate(trace.residual[axis], step);
  std::vector<double> t;
  for (std::size_t i = 0; i < time.size(); i += step) t.push_back(time[i]);
  std::vector<double> all = measured.low;
  all.insert(all.end(), measured.high.begin(), measured.high.end());
  all.insert(all.end(), residual.low.begin(), residual.low.end());
  svg::Plot plot({.label = "time [s]", .low = time.front(), .high = time.back()},
                 svg::axis_for(fmt::format("{} [{}]", "xyz"[axis], unit_text(trace)), all, svg::From::least),
                 {480.0, 190.0});
  for (const TimeWindow& window : motion.held_out) plot.window(window.begin, window.end, "stripe");
  plot.area(t, measured.low, measured.high, "area-before");
  plot.area(t, predicted.low, predicted.high, "area-after");
  plot.area(t, residual.low, residual.high, "area-rest");
  return fmt::format("<div><h4>{}, {} {}</h4>{}</div>", html::escape(trace.sensor), html::escape(quantity_text(trace)),
                     "xyz"[axis], plot.svg("Measured and predicted motion and their difference"));
}

/// The acceleration that is predicted worst; null if there is none.
const Trace* worst_acceleration(const MotionEvidence& motion, const std::vector<std::string>& sensors) {
  const Trace* worst = nullptr;
  for (const std::string& sensor : sensors) {
    const auto trace =
        std::ranges::find_if(motion.traces, [&](const Trace& t) { return t.sensor == sensor && is_acceleration(t); });
    if (trace != motion.traces.end() && (!worst || residual_rms(*trace) > residual_rms(*worst))) worst = &*trace;
  }
  return worst;
}

}  // namespace

std::string residual_drawing(const IdentificationEvidence& evidence) {
  const Trace* worst = worst_acceleration(evidence.motion, evidence.order.sensors);
  if (!worst) return "";
  const double motion = worst->rms_measured, rest = residual_rms(*worst);
  const auto bar = [&](const char* kind, const char* words, double value) {
    return fmt::format(
        "<div class=\"gain-row {}\"><span class=\"gain-name\">{}</span><span class=\"gain-track\"><i "
        "style=\"width:{:.1f}%\"></i></span><span class=\"gain-value\"><b>{}</b> m/s²</span></div>",
        kind, words, 100.0 * value / std::max(motion, rest), html::short_number(value));
  };
  return "<div class=\"gain\" role=\"img\" aria-label=\"Motion, and its residual\">" + bar("before", "motion", motion) +
         bar("after", "residual", rest) + "</div>";
}

std::string trace_drawings(const IdentificationEvidence& evidence) {
  std::string text;
  if (!evidence.motion.time.empty())
    for (const Trace& trace : evidence.motion.traces) text += trace_drawing(evidence.motion, trace);
  return "<div class=\"still two\">" + text + "</div>";
}

}  // namespace kinfer::report
