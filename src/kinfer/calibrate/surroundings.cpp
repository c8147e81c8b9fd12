#include "kinfer/calibrate/surroundings.hpp"

#include <algorithm>
#include <set>

#include "kinfer/estimate/residuals.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

template <class Named>
int find_by_name(const std::vector<Named>& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Named& entry) { return entry.name == name; });
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

/// The entries that are named, in that order, then the others.
template <class Named>
std::vector<Named> in_order_of(const std::vector<std::string>& names, const std::vector<Named>& known) {
  std::vector<Named> ordered;
  for (const std::string& name : names) {
    const int place = find_by_name(known, name);
    ordered.push_back(place >= 0 ? known[place] : Named{.name = name});
  }
  for (const Named& entry : known)
    if (find_by_name(ordered, entry.name) < 0) ordered.push_back(entry);
  return ordered;
}

void order_surroundings(Surroundings& around, const PoseSet& data) {
  const std::vector<Target> before = around.sockets;
  around.sockets = in_order_of(data.sockets, before);
  around.planes = in_order_of(data.planes, around.planes);
  for (SocketDistance& known : around.socket_distances)
    for (int* index : {&known.a, &known.b}) *index = find_by_name(around.sockets, before[*index].name);
}

std::string name_of(const PoseSet& data, const std::vector<int>& index, const std::vector<std::string>& names,
                    Eigen::Index row) {
  if (data.rows() == 0 || index.empty() || index[row] < 0) return {};
  return names[index[row]];
}

/// The set-up to which the chain's own base and tool belong: the one that the chain says, or the first where all rows
/// name one.
std::string own_setup(const Chain& chain, const PoseSet& data) {
  if (!chain.setup.empty() || data.setup.empty()) return chain.setup;
  if (std::find(data.setup.begin(), data.setup.end(), -1) != data.setup.end()) return {};
  return data.setups[data.setup.front()];
}

/// Index of the mounting for a set-up and a tip, added where it is new.
Result<int> mounting_of(Chain& chain, const std::string& setup, const std::string& tip) {
  const bool own_setup = setup.empty() || setup == chain.setup;
  const int tip_joint = tip.empty() ? chain.tip_joint() : find_by_name(chain.joints, tip);
  if (tip_joint < 0) return error("the pose set names the tip \"{}\", but no joint of the robot has this name", tip);
  const bool own_tip = tip_joint == chain.tip_joint();
  if (own_setup && own_tip) return -1;
  const std::string name = own_tip ? setup : own_setup ? tip : setup + "/" + tip;
  const int known = find_by_name(chain.mountings, name);
  if (known >= 0) return known;
  RobotMounting mounting{.name = name, .tool = chain.tool, .tip = own_tip ? -1 : tip_joint};
  if (!own_setup) mounting.base = chain.base;
  if (const int arm = find_by_name(chain.mountings, tip); arm >= 0) mounting.tool = chain.mountings[arm].tool;
  chain.mountings.push_back(mounting);
  return static_cast<int>(chain.mountings.size()) - 1;
}

std::vector<Vec3> tool_points(const Chain& chain, const PoseSet& data) {
  std::vector<Vec3> points;
  for (const Pose& pose : evaluate_poses(chain, {}, data, Derivative::no).pose) points.push_back(pose.position);
  return points;
}

Vec3 median_point(const std::vector<Vec3>& points) {
  Vec3 middle;
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Vec3& p : points) values.push_back(p[k]);
    middle[k] = median(std::move(values));
  }
  return middle;
}

Vec3 mean_point(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

void place(Plane& plane, const std::vector<Vec3>& points) {
  const PlaneFit fit = fit_plane(points);
  const Vec3 u = any_perpendicular(fit.normal);
  plane.rotation << u, fit.normal.cross(u), fit.normal;
  plane.turn.setZero();
  plane.offset = fit.normal.dot(fit.point);
}

/// Tool points by socket or by plane.
template <class Contact>
std::vector<std::vector<Vec3>> grouped(const std::vector<Contact>& contacts, int Contact::*of, std::size_t groups,
                                       const std::vector<Vec3>& points) {
  std::vector<std::vector<Vec3>> lists(groups);
  for (const Contact& contact : contacts) lists[contact.*of].push_back(points[contact.row]);
  return lists;
}

}  // namespace

Result<PlacedData> with_surroundings(const Chain& given, const PoseSet& data) {
  PlacedData placed{given, data};
  Chain& chain = placed.chain;
  for (const DistanceMeasurement& wire : data.distances)
    if (wire.anchor >= static_cast<int>(chain.surroundings.anchors.size()))
      return error("a distance is measured from anchor {}, but the robot file lists {} anchors", wire.anchor + 1,
                   chain.surroundings.anchors.size());
  order_surroundings(chain.surroundings, data);
  chain.setup = own_setup(chain, data);
  if (data.setups.empty() && data.tips.empty()) return placed;
  placed.data.mounting.assign(data.rows(), -1);
  for (Eigen::Index row = 0; row < data.rows(); ++row) {
    KINFER_TRY(index, mounting_of(chain, name_of(data, data.setup, data.setups, row),
                                  name_of(data, data.tip, data.tips, row)));
    placed.data.mounting[row] = index;
  }
  return placed;
}

Chain with_placed_surroundings(const Chain& chain, const PoseSet& data) {
  Chain placed = chain;
  Surroundings& around = placed.surroundings;
  if (data.contacts.empty() && data.plane_contacts.empty()) return placed;
  const std::vector<Vec3> points = tool_points(chain, data);
  const auto in_sockets = grouped(data.contacts, &SocketContact::socket, around.sockets.size(), points);
  for (std::size_t i = 0; i < in_sockets.size(); ++i)
    if (!in_sockets[i].empty()) around.sockets[i].xyz = median_point(in_sockets[i]);
  const auto on_planes = grouped(data.plane_contacts, &PlaneContact::plane, around.planes.size(), points);
  for (std::size_t i = 0; i < on_planes.size(); ++i)
    if (on_planes[i].size() >= 3) place(around.planes[i], on_planes[i]);
  return placed;
}

Chain with_unseen_surroundings(const Chain& chain, const PoseSet& seen, const PoseSet& judged) {
  Chain placed = chain;
  Surroundings& around = placed.surroundings;
  if (judged.contacts.empty() && judged.plane_contacts.empty()) return placed;
  std::set<int> sockets, planes;
  for (const SocketContact& contact : seen.contacts) sockets.insert(contact.socket);
  for (const PlaneContact& contact : seen.plane_contacts) planes.insert(contact.plane);
  const std::vector<Vec3> points = tool_points(chain, judged);
  const auto in_sockets = grouped(judged.contacts, &SocketContact::socket, around.sockets.size(), points);
  for (std::size_t i = 0; i < in_sockets.size(); ++i)
    if (!in_sockets[i].empty() && !sockets.contains(static_cast<int>(i)))
      around.sockets[i].xyz = mean_point(in_sockets[i]);
  const auto on_planes = grouped(judged.plane_contacts, &PlaneContact::plane, around.planes.size(), points);
  for (std::size_t i = 0; i < on_planes.size(); ++i)
    if (on_planes[i].size() >= 3 && !planes.contains(static_cast<int>(i))) place(around.planes[i], on_planes[i]);
  return placed;
}

}  // namespace kinfer
