// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/identification_json.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/drawing_json.hpp"
#include "kinfer/io/evidence/findings_json.hpp"
#include "kinfer/io/evidence/json_parts.hpp"
#include "kinfer/words/identification_advice.hpp"
#include "kinfer/words/identification_notes.hpp"
#include "kinfer/words/identification_unobservable.hpp"
#include "kinfer/words/identification_verdict.hpp"

namespace kinfer {
namespace {

using Json = nlohmann::ordered_json;
using kinfer::json_of;  // in addition to the overloads below

Json json_of(const std::vector<Vec3>& vectors) {
  Json list = Json::array();
  for (const Vec3& v : vectors) list.push_back(json_of(v));
  return list;
}

Json json_of(const JointStandardDeviation& sd) {
  return {{"axis_in_parent_rad", sd.axis_in_parent},
          {"point_in_parent_m", sd.point_in_parent},
          {"axis_in_child_rad", sd.axis_in_child},
          {"point_in_child_m", sd.point_in_child},
          {"slide_m", sd.along_axis}};
}

/// A spherical joint has no axis.
Json axis_json(const JointEstimate& joint, const Vec3& axis) {
  return joint.type == EstimatedJointType::spherical ? Json(nullptr) : json_of(axis);
}

Json unobservable_json(const JointEstimate& joint) {
  Json list = Json::array();
  for (const Unobservable& u : joint.unobservable) {
    Json json{{"kind", name(u.kind)},
              {"remedy", name(remedy(u.kind))},
              {"what", words::unobservable_text(u, joint)},
              {"how", words::remedy_text(u)}};
    if (!u.sensor.empty()) json["sensor"] = u.sensor;
    if (!u.directions.empty()) json["directions"] = json_of(u.directions);
    if (!u.other_joint.empty()) json["other_joint"] = u.other_joint;
    list.push_back(json);
  }
  return list;
}

Json json_of(const JointEstimate& joint) {
  Json json{{"parent", joint.parent},
            {"child", joint.child},
            {"type", name(joint.type)},
            {"axis_in_parent", axis_json(joint, joint.axis_in_parent)},
            {"point_in_parent", json_of(joint.point_in_parent)},
            {"axis_in_child", axis_json(joint, joint.axis_in_child)},
            {"point_in_child", json_of(joint.point_in_child)},
            {"sd", json_of(joint.sd)},
            {"not_identifiable", words::unobservable_sentences(joint)},
            {"not_identifiable_in_parent", json_of(joint.unobservable_in_parent)},
            {"not_identifiable_in_child", json_of(joint.unobservable_in_child)},
            {"unobservable", unobservable_json(joint)}};
  if (joint.azimuth_unobservable) json["azimuth_undetermined"] = true;
  return json;
}

Json json_of(const LinkEstimate& link) {
  return {
      {"segment", link.segment}, {"from", link.from}, {"to", link.to}, {"length_m", link.length}, {"sd_m", link.sd}};
}

Json json_of(const PointEstimate& place) {
  return {{"name", place.name}, {"sensor", place.sensor}, {"xyz", json_of(place.xyz)}, {"sd_m", json_of(place.sd)}};
}

Json json_of(const SensorClockEstimate& clock) {
  return {{"sensor", clock.sensor},
          {"offset_s", clock.offset},
          {"drift_ppm", 1e6 * clock.drift},
          {"sd", {{"offset_s", clock.offset_sd}, {"drift_ppm", 1e6 * clock.drift_sd}}}};
}

Json json_of(const JointForecast& f) {
  Json json{{"joint", f.joint},
            {"line_sd_m", f.line_sd},
            {"direction_sd_rad", f.direction_sd},
            {"enough", f.is_sufficient},
            {"acceleration_factor", f.acceleration_factor},
            {"time_factor", f.time_factor}};
  if (!f.azimuth_of.empty()) {
    json["azimuth_of"] = f.azimuth_of;
    json["azimuth_sd_rad"] = f.azimuth_sd;
  }
  return json;
}

Json json_of(const LinkFit& fit) {
  return {{"total", fit.total}, {"acceleration", fit.acceleration}, {"orientation", fit.orientation}};
}

Json json_of(const DhRowEstimate& row) {
  return {{"segment", row.segment},
          {"theta", row.row.theta},
          {"d", row.row.d},
          {"a", row.row.a},
          {"alpha", row.row.alpha},
          {"theta_variable", row.theta_variable},
          {"alpha_variable", row.alpha_variable},
          {"d_variable", row.d_variable}};
}

Json json_of(const OrderEvidence& order) {
  Json pairs = Json::array(), phases = Json::array();
  for (const PairEvidence& p : order.pairs)
    pairs.push_back({{"first", p.first},
                     {"second", p.second},
                     {"residual", p.residual},
                     {"off_axis_rate", p.off_axis_rate},
                     {"weight", p.weight},
                     {"joined", p.joined}});
  for (const PhaseEvidence& p : order.phases)
    phases.push_back({{"begin", p.begin}, {"end", p.end}, {"moves", p.moves}});
  return {
      {"sensors", order.sensors}, {"pairs", pairs},     {"margin", order.margin ? Json(*order.margin) : Json(nullptr)},
      {"phases", phases},         {"rank", order.rank}, {"phases_agree", order.phases_agree}};
}

Json dh_json(const std::vector<DhRowEstimate>& rows) {
  Json list = Json::array();
  for (const DhRowEstimate& row : rows) {
    Json json = json_of(row);
    json["beta"] = row.row.beta;
    json["sd"] = {
        {"theta", row.sd.theta}, {"d", row.sd.d}, {"a", row.sd.a}, {"alpha", row.sd.alpha}, {"beta", row.sd.beta}};
    list.push_back(json);
  }
  return list;
}

template <class List>
Json list_of(const List& list) {
  Json json = Json::array();
  for (const auto& item : list) json.push_back(json_of(item));
  return json;
}

Json fit_json(const std::vector<LinkEvidence>& searches) {
  Json fitted = Json::array(), holdout = Json::object();
  for (const LinkEvidence& s : searches) {
    Json fit = json_of(s.fitted);
    fit["segment"] = s.segment;
    fit["rows"] = s.rows;
    fitted.push_back(fit);
    holdout[s.segment] = json_of(s.holdout);
  }
  return {{"jrmse", fitted}, {"holdout", holdout}};
}

Json search_json(const Identification& found) {
  std::int64_t evaluations = 0;
  int generations = 0;
  Json best = Json::array(), median = Json::array(), segments = Json::array();
  for (const LinkEvidence& s : found.searches) {
    evaluations += s.evaluations;
    generations += s.generations;
    best.push_back(s.best);
    median.push_back(s.median);
    segments.push_back({{"segment", s.segment},
                        {"evaluations", s.evaluations},
                        {"found", list_of(s.found)},
                        {"merged", list_of(s.merged)}});
  }
  return {{"engine", name(found.search_method)},
          {"evaluations", evaluations},
          {"generations", generations},
          {"best", best},
          {"median", median},
          {"segments", segments}};
}

}  // namespace

std::string format_identification_evidence(const Identification& found, const Provenance& provenance) {
  Json json;
  json["format"] = "kinfer-evidence/1";
  json["kind"] = "identify";
  json["verdict"] = words::identification_verdict(found);
  json["use"] = found.usability != Usability::do_not_use;
  json["usability"] = name(found.usability);
  json["findings"] = Json::parse(format_findings(found.findings));
  json["notes"] = words::note_sentences(found);
  json["root"] = found.root;
  json["joints"] = list_of(found.joints);
  json["links"] = list_of(found.links);
  json["dh"] = dh_json(found.dh);
  json["chain"] = chain_json(found.chain);
  json["next"] = advice_json(words::advice_texts(found.advice));
  json["places"] = list_of(found.places);
  json["clocks"] = list_of(found.clocks);
  json["forecast"] = list_of(found.forecast);
  json["order"] = json_of(found.order);
  json["fit"] = fit_json(found.searches);
  json["search"] = search_json(found);
  json["motion"] = motion_json(found.motion);
  json["provenance"] = provenance_json(provenance);
  return json.dump(1) + "\n";
}

std::string format_identification_headline(const Identification& found) {
  const Json json{{"verdict", words::identification_verdict(found)},
                  {"use", found.usability != Usability::do_not_use},
                  {"usability", name(found.usability)},
                  {"root", found.root},
                  {"joints", list_of(found.joints)},
                  {"links", list_of(found.links)},
                  {"fit", fit_json(found.searches)}};
  return json.dump() + "\n";
}

}  // namespace kinfer
