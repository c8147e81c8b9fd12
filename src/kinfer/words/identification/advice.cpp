// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/advice.hpp"

#include <fmt/ranges.h>

#include "kinfer/words/identification/forecast.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

Advice move_in_sequence(const FactValues& v) {
  return {phrase("move_in_sequence", "Move one joint after the other, each for several seconds, and identify again"),
          phrase("move_in_sequence.why",
                 "another order of the segments fits almost as well (margin {:.2f}; {:.0f} is safe)",
                 v.number("margin"), v.number("safe_margin"))};
}

std::string joint_accuracy(const FactValues& v) {
  if (!v.has("line_sd")) return phrase("joint_undetermined", "the recording does not determine where its axis is");
  return phrase("joint_accuracy", "its line is known to {:.1f} mm and its direction to {:.1f} mrad only",
                1e3 * v.number("line_sd"), 1e3 * v.number("direction_sd"));
}

Advice move_further(const FactValues& v) {
  return {phrase("move_further", "Move {} further and faster: {:.1f} times the acceleration, or {:.1f} times as long",
                 v.text("joint"), v.number("acceleration_factor"), v.number("time_factor")),
          joint_accuracy(v)};
}

Advice check_mounts(const FactValues& v) {
  return {phrase("check_mounts", "Check the sensors beside {}: mount them firmly, then move it much further",
                 v.text("joint")),
          joint_accuracy(v)};
}

Advice record_on_slope(const FactValues& v) {
  std::vector<std::string> items;
  for (const std::string& sensor : v.texts("azimuths"))
    items.push_back(fmt::format("the azimuth of {} about the axis", sensor));
  const auto& uncertain = v.texts("uncertain_azimuths");
  for (std::size_t i = 0; i < uncertain.size(); ++i)
    items.push_back(azimuth_text(uncertain[i], v.numbers("azimuth_sds")[i], v.counts("azimuth_unobservable")[i] != 0));
  if (const auto& sensors = v.texts("points_in"); !sensors.empty())
    items.push_back(fmt::format("positions in {}", fmt::join(sensors, " and in ")));
  return {phrase("record_on_slope",
                 "Drive once on a slope and let the base rock, or measure with a tape, if positions are wanted from "
                 "the root"),
          phrase("record_on_slope.why", "unobservable on level ground: {}; the joints beyond do not need it",
                 fmt::join(items, ", and "))};
}

}  // namespace

Advice advice_text(const IdentificationAdvice& advice) {
  const FactValues& v = advice.values;
  switch (advice.kind) {
    case IdentificationAdviceKind::move_in_sequence:
      return move_in_sequence(v);
    case IdentificationAdviceKind::use_chain:
      return {phrase("use_chain", "Put it to use: the chain is in chain.toml, chain.urdf, chain.mjcf and chain_dh.csv"),
              phrase("use_chain.why", "each holds every joint in the frames of the INS beside it")};
    case IdentificationAdviceKind::move_joint:
      return {phrase("move_joint", "Move the joint between {} and {}", v.text("parent"), v.text("child")),
              phrase("move_joint.why",
                     "the two never moved relative to each other, so nothing is known about a joint there")};
    case IdentificationAdviceKind::move_further:
      return move_further(v);
    case IdentificationAdviceKind::check_mounts:
      return check_mounts(v);
    case IdentificationAdviceKind::record_on_slope:
      return record_on_slope(v);
    case IdentificationAdviceKind::measure_tool:
      break;
  }
  return {
      phrase("measure_tool", "Measure where the tool is in {} with a tape, or touch one known point", v.text("sensor")),
      phrase("measure_tool.why", "what lies beyond the last INS is unobservable")};
}

std::vector<Advice> advice_texts(const std::vector<IdentificationAdvice>& list) {
  std::vector<Advice> texts;
  for (const IdentificationAdvice& advice : list) texts.push_back(advice_text(advice));
  return texts;
}

}  // namespace kinfer::words
