// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings/log_findings.hpp"

#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "kinfer/base/constants.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

struct UnitName {
  double unit;
  const char* text;
};

template <std::size_t N>
std::string name_of(const std::array<UnitName, N>& names, double unit) {
  for (const UnitName& n : names)
    if (std::abs(unit / n.unit - 1.0) < 1e-6) return n.text;
  return fmt::format("{:.4g} of the SI unit", unit);
}

std::string sensors_of(const Finding& f) {
  return fmt::format("{}", fmt::join(f.values.texts("sensors"), ", "));
}

std::string clock_unit_sentence(const Finding& f) {
  constexpr std::array names{UnitName{1e-3, "ms"}, UnitName{1e-6, "µs"}, UnitName{1e-9, "ns"}};
  return phrase("clock_unit", "the times of {} are in {}, and were converted", f.values.text("logger"),
                name_of(names, f.values.number("unit")));
}

std::string clock_unit_suggestion(const Finding&) {
  return phrase("clock_unit.suggestion", "state the unit in the header: t[ms], t[us]");
}

std::string clock_counts_sentence(const Finding& f) {
  return phrase(
      "clock_counts",
      "the times of {} count rows; {:.0f} rows a second fit gyroscopes and accelerometers best, and are assumed",
      f.values.text("logger"), f.values.number("rate"));
}

std::string clock_counts_suggestion(const Finding&) {
  return phrase("clock_counts.suggestion", "state the sampling rate with --columns: rate = 100");
}

std::string force_unit_sentence(const Finding& f) {
  const std::array names{UnitName{standard_gravity, "g"}, UnitName{1e-3 * standard_gravity, "mg"},
                         UnitName{1e-3, "mm/s²"}};
  return phrase("force_unit", "the specific forces of {} are in {}, by the size of gravity, and were converted",
                sensors_of(f), name_of(names, f.values.number("unit")));
}

std::string force_unit_suggestion(const Finding& f) {
  const std::string& sensor = f.values.texts("sensors").front();
  return phrase("force_unit.suggestion", "state the unit in the header: {}_ax[g]", sensor);
}

/// Where 1 g was taken for 10 m/s².
bool is_ten_for_one_g(const Finding& f) {
  return std::abs(f.values.number("scale") - (10.0 / standard_gravity - 1.0)) < f.values.number("sd");
}

std::string force_scale_sentence(const Finding& f) {
  const double scale = f.values.number("scale");
  return phrase("force_scale",
                "all accelerometers read {:.2f} ± {:.2f} % too {}: at rest they show a gravity of {:.3f} m/s², which "
                "lies between {:.3f} and {:.3f} on Earth{}; they were corrected, and lengths are so uncertain",
                100.0 * std::abs(scale), 100.0 * f.values.number("sd"), scale > 0.0 ? "much" : "little",
                f.values.number("gravity"), least_gravity, largest_gravity,
                is_ten_for_one_g(f) ? " (1 g may have been taken for 10 m/s²)" : "");
}

std::string force_scale_suggestion(const Finding&) {
  return phrase("force_scale.suggestion",
                "check the unit (1 g is 9.80665 m/s²), have the accelerometers calibrated, or measure one length "
                "(--facts)");
}

std::string rate_unit_sentence(const Finding& f) {
  constexpr std::array names{UnitName{degree, "deg/s"}, UnitName{1e-3, "mrad/s"}, UnitName{1e-3 * degree, "mdeg/s"},
                             UnitName{1.0 / degree, "rad/s, and had been converted as if they were in deg/s"}};
  return phrase("rate_unit",
                "the angular rates of {} are in {}: gravity arrives where the gyroscopes carry it; they were converted",
                sensors_of(f), name_of(names, f.values.number("unit")));
}

std::string rate_unit_suggestion(const Finding& f) {
  const bool is_radians = f.values.number("unit") > 1.0;
  return phrase("rate_unit.suggestion", "state the unit in the header: {}_gx[{}]", f.values.texts("sensors").front(),
                is_radians ? "rad/s" : "deg/s");
}

std::string field_unit_sentence(const Finding& f) {
  constexpr std::array names{UnitName{100.0, "gauss"}, UnitName{1e3, "mT"}, UnitName{1e6, "T"}, UnitName{1e-3, "nT"}};
  return phrase("field_unit", "the magnetic fields of {} are in {}, by the size of the Earth's, and were converted",
                sensors_of(f), name_of(names, f.values.number("unit")));
}

std::string field_unit_suggestion(const Finding& f) {
  return phrase("field_unit.suggestion", "state the unit in the header: {}_mx[mT]", f.values.texts("sensors").front());
}

std::string repeated_rows_sentence(const Finding& f) {
  return phrase("repeated_rows", "{:.0f} % of the rows of {}'s {} repeat the row before; the copies are not used",
                100.0 * f.values.number("share"), f.values.text("sensor"), f.values.text("instrument"));
}

std::string interpolated_rows_sentence(const Finding& f) {
  return phrase("interpolated_rows",
                "{:.0f} % of the rows of {}'s {} lie on straight lines between others: the log was resampled; they are "
                "not used",
                100.0 * f.values.number("share"), f.values.text("sensor"), f.values.text("instrument"));
}

std::string rows_suggestion(const Finding&) {
  return phrase("rows.suggestion", "export each instrument at its own sampling rate");
}

std::string rates_unrelated_sentence(const Finding& f) {
  return phrase(
      "rates_unrelated",
      "what stands in the gyroscopes' columns of {} explains nothing of how gravity moves in the sensors, in no "
      "unit and no order of axes: no angular rates, or those of other sensors",
      sensors_of(f));
}

std::string rates_unrelated_suggestion(const Finding&) {
  return phrase("rates_unrelated.suggestion", "check which columns hold what the gyroscopes measure");
}

std::string rate_sign_sentence(const Finding& f) {
  const std::string& sensor = f.values.text("sensor");
  if (f.applied)
    return phrase("rate_sign", "the gyroscope of {} turns the other way round than its accelerometer; it was reversed",
                  sensor);
  return phrase(
      "rate_sign_or_left_handed",
      "the gyroscope of {} turns the other way round than its accelerometer: its sign is wrong, or the sensor's "
      "axes are left-handed; the gyroscope was reversed, with left-handed axes lever arms come out mirrored",
      sensor);
}

std::string rate_sign_suggestion(const Finding& f) {
  return phrase("rate_sign.suggestion",
                "reverse {0}_gx, {0}_gy, {0}_gz with --columns (sign), or one axis of all instruments (axes)",
                f.values.text("sensor"));
}

std::string left_handed_sentence(const Finding& f) {
  return phrase("left_handed",
                "the axes of {} are left-handed, by its own gyroscope and its neighbours; they were mirrored",
                f.values.text("sensor"));
}

std::string left_handed_suggestion(const Finding&) {
  return phrase("left_handed.suggestion", "write right-handed axes, or axes = [\"-x\", \"y\", \"z\"] in --columns");
}

std::string instrument_axes_sentence(const Finding& f) {
  const FactValues& v = f.values;
  return phrase("instrument_axes", "the {} of {} has other axes than its other instruments: theirs are its {}; {}",
                v.text("instrument"), v.text("sensor"), v.text("axes"),
                f.applied ? "it was mapped to them" : "this map fits best, but another one nearly as well");
}

std::string instrument_axes_suggestion(const Finding& f) {
  const std::string& instrument = f.values.text("instrument");
  const char letter = instrument == "gyroscope" ? 'g' : instrument == "accelerometer" ? 'a' : 'm';
  return phrase("instrument_axes.suggestion", "check the columns {0}_{1}x, {0}_{1}y, {0}_{1}z", f.values.text("sensor"),
                letter);
}

std::string force_sign_sentence(const Finding& f) {
  if (f.applied)
    return phrase("force_sign", "the accelerometer of {} reads -g upwards, by its neighbours; it was negated",
                  sensors_of(f));
  return phrase(
      "force_sign_of_all",
      "the magnetic field points out of the ground where the accelerometers of {} see up: they read -g upwards, "
      "or the log is from the southern hemisphere; if they do, all lever arms are mirrored",
      sensors_of(f));
}

std::string force_sign_suggestion(const Finding& f) {
  if (f.applied) return phrase("force_sign.suggestion", "write specific force: +g upwards at rest");
  return phrase(
      "force_sign_of_all.suggestion",
      "check that a sensor at rest reads +9.81 m/s² on the axis that points up, else negate (sign in --columns)");
}

std::string opposite_verticals_sentence(const Finding& f) {
  return phrase(
      "opposite_verticals",
      "{} and {} see each other's rotation about the vertical reversed: the accelerometers of one side read -g "
      "upwards, or its axes are left-handed; the recording does not tell which",
      fmt::join(f.values.texts("sensors"), ", "), fmt::join(f.values.texts("others"), ", "));
}

std::string opposite_verticals_suggestion(const Finding&) {
  return phrase("opposite_verticals.suggestion",
                "check which sensor reads +9.81 m/s² at rest on the axis that points up, and negate the other");
}

std::string out_of_step_sentence(const Finding& f) {
  const double lag = f.values.number("lag");
  return phrase("instruments_out_of_step",
                "the accelerometer of {} is logged {:.0f} ± {:.0f} ms {} than its gyroscope: a filter's delay, or "
                "instruments logged apart; it was shifted",
                f.values.text("sensor"), 1e3 * std::abs(lag), 1e3 * f.values.number("sd"),
                lag > 0.0 ? "later" : "earlier");
}

std::string out_of_step_suggestion(const Finding&) {
  return phrase("instruments_out_of_step.suggestion", "log unfiltered samples, with one time for both instruments");
}

constexpr std::array table_of_log_words{
    FindingWords{FindingKind::clock_unit, clock_unit_sentence, clock_unit_suggestion},
    FindingWords{FindingKind::clock_counts, clock_counts_sentence, clock_counts_suggestion},
    FindingWords{FindingKind::force_unit, force_unit_sentence, force_unit_suggestion},
    FindingWords{FindingKind::force_scale, force_scale_sentence, force_scale_suggestion},
    FindingWords{FindingKind::rate_unit, rate_unit_sentence, rate_unit_suggestion},
    FindingWords{FindingKind::field_unit, field_unit_sentence, field_unit_suggestion},
    FindingWords{FindingKind::repeated_rows, repeated_rows_sentence, rows_suggestion},
    FindingWords{FindingKind::interpolated_rows, interpolated_rows_sentence, rows_suggestion},
    FindingWords{FindingKind::rates_unrelated, rates_unrelated_sentence, rates_unrelated_suggestion},
    FindingWords{FindingKind::rate_sign, rate_sign_sentence, rate_sign_suggestion},
    FindingWords{FindingKind::left_handed, left_handed_sentence, left_handed_suggestion},
    FindingWords{FindingKind::instrument_axes, instrument_axes_sentence, instrument_axes_suggestion},
    FindingWords{FindingKind::force_sign, force_sign_sentence, force_sign_suggestion},
    FindingWords{FindingKind::opposite_verticals, opposite_verticals_sentence, opposite_verticals_suggestion},
    FindingWords{FindingKind::instruments_out_of_step, out_of_step_sentence, out_of_step_suggestion},
};

}  // namespace

std::span<const FindingWords> log_words() {
  return table_of_log_words;
}

}  // namespace kinfer::words
