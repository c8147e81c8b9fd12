// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/fixtures_toml.hpp"

#include <fmt/format.h>

#include <type_traits>

#include "kinfer/io/robot/toml/joints_toml.hpp"

namespace kinfer {
namespace {

/// The functions `read_fixture` read a table [[kind]] by the type of the fixture.
Target read_fixture(TableReader& row, const Scales& scales, Target target) {
  target.name = row.text("name"), target.xyz = row.vector_or("xyz", Vec3::Zero()) * scales.length;
  row.ignore("xyz_sd");
  return target;
}

Plane read_fixture(TableReader& row, const Scales& scales, Plane plane) {
  plane.name = row.text("name"), plane.offset = row.number("offset") * scales.length;
  const Vec3 normal = row.vector("normal");
  if (normal.norm() > 0.0) plane.rotation = rotation_between(Vec3::UnitZ(), normal).toRotationMatrix();
  row.ignore("offset_sd");
  return plane;
}

NamedFrame read_fixture(TableReader& row, const Scales& scales, NamedFrame fixture) {
  fixture.name = row.text("name");
  const Vec3 xyz = row.vector_or("xyz", Vec3::Zero()), rpy = row.vector_or("rpy", Vec3::Zero());
  fixture.frame = {xyz * scales.length, from_rpy(rpy * scales.angle), Vec3::Zero()};
  row.ignore("xyz_sd"), row.ignore("turn_sd");
  return fixture;
}

template <class T>
std::vector<T> read_fixture_list(TableReader& file, std::string_view kind, const Scales& scales,
                                 FirstError& first_error) {
  std::vector<T> fixtures;
  for (const auto& [table, line] : file.tables_or_none(kind)) {
    TableReader row(*table, line, fmt::format("{} {}: ", kind, fixtures.size() + 1), first_error);
    fixtures.push_back(read_fixture(row, scales, T{}));
    row.expect_no_other_keys();
  }
  return fixtures;
}

/// Points without a name are one array: "anchors" of the kind "anchor".
std::vector<Vec3> read_points(TableReader& file, const std::string& key, const Scales& scales) {
  std::vector<Vec3> points = file.vectors_or_none(key);
  for (Vec3& point : points) point *= scales.length;
  file.ignore(key + "_sd");
  return points;
}

/// Index of the socket of that name, which is added at the origin where the file has no [[socket]] of that name.
int socket_index(std::vector<Target>& sockets, const std::string& name) {
  for (std::size_t i = 0; i < sockets.size(); ++i)
    if (sockets[i].name == name) return static_cast<int>(i);
  sockets.push_back({name, Vec3::Zero()});
  return static_cast<int>(sockets.size()) - 1;
}

}  // namespace

std::vector<Target> read_targets(TableReader& file, const Scales& scales, FirstError& first_error) {
  std::vector<Target> targets;
  for (const auto& [table, line] : file.tables_or_none("target")) {
    TableReader row(*table, line, fmt::format("target {}: ", targets.size() + 1), first_error);
    Target target{row.text("name"), row.vector("xyz") * scales.length};
    row.ignore("xyz_sd");
    row.expect_no_other_keys();
    for (const Target& other : targets)
      if (other.name == target.name) row.report_error(line, fmt::format("the name \"{}\" is taken", target.name));
    targets.push_back(std::move(target));
  }
  return targets;
}

Fixtures read_fixtures(TableReader& file, const Scales& scales, FirstError& first_error) {
  Fixtures fixtures;
  for_each_fixture_list(fixtures, [&]<class T>(const auto& row, std::vector<T>& list) {
    if constexpr (std::is_same_v<T, Vec3>)
      list = read_points(file, std::string(row.kind) + "s", scales);
    else
      list = read_fixture_list<T>(file, row.kind, scales, first_error);
  });
  return fixtures;
}

void read_socket_distances(TableReader& file, Fixtures& fixtures, const Scales& scales, FirstError& first_error) {
  for (const auto& [table, line] : file.tables_or_none("socket_distance")) {
    TableReader row(*table, line, fmt::format("socket_distance {}: ", fixtures.socket_distances.size() + 1),
                    first_error);
    const std::string a = row.text("from"), b = row.text("to");
    SocketDistance known{socket_index(fixtures.sockets, a), socket_index(fixtures.sockets, b)};
    known.distance = row.number("distance") * scales.length;
    known.sd = row.positive_or("sigma", 1e-5 / scales.length) * scales.length;
    row.expect_no_other_keys();
    if (a == b) row.report_error(line, "expected two different sockets");
    fixtures.socket_distances.push_back(known);
  }
}

std::vector<RobotMounting> read_mountings(TableReader& file, const std::vector<Joint>& joints, const Scales& scales,
                                          FirstError& first_error) {
  std::vector<RobotMounting> mountings;
  for (const auto& [table, line] : file.tables_or_none("mounting")) {
    TableReader row(*table, line, fmt::format("mounting {}: ", mountings.size() + 1), first_error);
    RobotMounting mounting{.name = row.text("name")};
    if (row.has("base")) mounting.base = read_frame(row, "base", scales, first_error);
    row.ignore("base"), row.ignore("base_sd");
    mounting.tool = read_frame(row, "tool", scales, first_error);
    mounting.tip = row.has("tip") ? read_joint_reference(row, "tip", joints) : (row.ignore("tip"), -1);
    row.expect_no_other_keys();
    mountings.push_back(std::move(mounting));
  }
  return mountings;
}

}  // namespace kinfer
