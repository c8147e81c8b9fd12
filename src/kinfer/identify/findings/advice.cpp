// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/advice.hpp"

#include <algorithm>

#include "kinfer/identify/findings/thresholds.hpp"

namespace kinfer::identify {
namespace {

using AdviceList = std::vector<IdentificationAdvice>;

void recommend_sequential_motion(const Identification& result, AdviceList& list) {
  if (!result.order.margin || *result.order.margin >= safe_margin) return;
  list.push_back(
      {IdentificationAdviceKind::move_in_sequence, {{"margin", *result.order.margin}, {"safe_margin", safe_margin}}});
}

void recommend_use(const Identification& result, AdviceList& list) {
  if (result.usability != Usability::do_not_use) list.push_back({IdentificationAdviceKind::use_chain, {}});
}

void recommend_moving_rigid_joints(const Identification& result, AdviceList& list) {
  for (const JointEstimate& joint : result.joints)
    if (joint.type == EstimatedJointType::rigid)
      list.push_back({IdentificationAdviceKind::move_joint, {{"parent", joint.parent}, {"child", joint.child}}});
}

void recommend_more_excitation(const Identification& result, AdviceList& list) {
  for (const JointForecast& f : result.forecast) {
    if (f.is_sufficient) continue;
    FactValues values{{"joint", f.joint}};
    if (is_determined(f)) {
      values.set("line_sd", f.line_sd);
      values.set("direction_sd", f.direction_sd);
    }
    if (f.more_excitation_suffices) {
      values.set("acceleration_factor", f.acceleration_factor);
      values.set("time_factor", f.time_factor);
    }
    list.push_back(
        {f.more_excitation_suffices ? IdentificationAdviceKind::move_further : IdentificationAdviceKind::check_mounts,
         std::move(values)});
  }
}

/// Unobservable on level ground with a base that does not rock: rotations about the vertical axis and its location.
void recommend_slope(const Identification& result, AdviceList& list) {
  std::vector<std::string> azimuths, uncertain_azimuths, points_in;
  std::vector<double> azimuth_sds;
  std::vector<int> azimuth_unobservable;
  for (const JointEstimate& joint : result.joints) {
    if (joint.azimuth_unobservable) azimuths.push_back(joint.child);
    if (!joint.unobservable_in_parent.empty()) points_in.push_back(joint.parent);
  }
  for (const JointForecast& f : result.forecast) {
    if (!f.azimuth_is_uncertain) continue;
    uncertain_azimuths.push_back(f.azimuth_of);
    azimuth_sds.push_back(f.azimuth_sd);
    azimuth_unobservable.push_back(f.azimuth_is_unobservable ? 1 : 0);
  }
  if (azimuths.empty() && uncertain_azimuths.empty() && points_in.empty()) return;
  list.push_back({IdentificationAdviceKind::record_on_slope,
                  {{"azimuths", azimuths},
                   {"uncertain_azimuths", uncertain_azimuths},
                   {"azimuth_sds", azimuth_sds},
                   {"azimuth_unobservable", azimuth_unobservable},
                   {"points_in", points_in}}});
}

/// End segments: the position of the tool relative to the last sensor is unobservable.
void recommend_tool_measurement(const Identification& result, AdviceList& list) {
  for (const JointEstimate& joint : result.joints)
    if (std::ranges::find(result.joints, joint.child, &JointEstimate::parent) == result.joints.end())
      list.push_back({IdentificationAdviceKind::measure_tool, {{"sensor", joint.child}}});
}

}  // namespace

std::vector<IdentificationAdvice> identification_advice(const Identification& result) {
  AdviceList list;
  recommend_sequential_motion(result, list);
  recommend_use(result, list);
  recommend_moving_rigid_joints(result, list);
  recommend_more_excitation(result, list);
  recommend_slope(result, list);
  recommend_tool_measurement(result, list);
  return list;
}

}  // namespace kinfer::identify
